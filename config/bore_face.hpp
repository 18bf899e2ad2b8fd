#pragma once

#include "calib_core/geometry/face.hpp"
#include "config/cell.hpp"
#include "config/json_value.hpp"

namespace cell {

/// A bore among the faces of a block's file: the inside of a cylinder, of which a part of the wall may be
/// touched. Keys, rules and their reasons: FILES.md.
JsonObject bore_object(const JsonValue& item);

/// The face and what is uncertain of it go into the block. `is_estimated`: its place is. ConfigError.
void add_bore(const JsonObject& object, bool is_estimated, Block& block);

/// Makes the hole in the solid that the file names; all solids and faces of the block have to be there.
/// ConfigError where the bore is not in that solid, or opens in what may be touched of a flat face.
void cut_bore(const JsonObject& object, const calib::Face& bore, Block& block);

/// A unit vector of a file; ConfigError.
Eigen::Vector3d unit_vector(const JsonValue& value);

}  // namespace cell
