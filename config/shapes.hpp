#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "calib_core/motion/collision.hpp"
#include "config/json_value.hpp"

/// The solids and poses that several files describe in the same words.
namespace cell {

/// A frame in another one, turned by Rot(x) Rot(y) Rot(z), as VAL3's trsf.
Eigen::Isometry3d pose_of_trsf_angles(const Eigen::Vector3d& position_m, const Eigen::Vector3d& angles_rad);

/// "position_mm":[3] and "rotation_deg":[3] of an object: a frame in another one. The rotation is Rot(x)
/// Rot(y) Rot(z), as in VAL3's trsf.
Eigen::Isometry3d pose_from_json(const JsonObject& object);

/// {"name","min_mm":[3],"max_mm":[3]}: edges along R_-1's axes, min below max.
calib::Box box_from_json(const JsonValue& value);
std::vector<calib::Box> boxes_from_json(const JsonValue& value);

/// [{"name","frame","from_mm":[3],"to_mm":[3],"radius_mm"}, ...]; "name" may be left out. With `only_frame`
/// "frame" may be left out too, and is that one.
std::vector<calib::Capsule> capsules_from_json(const JsonValue& value,
                                               std::optional<int> only_frame = std::nullopt);

}  // namespace cell
