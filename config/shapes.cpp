#include "config/shapes.hpp"

#include "calib_core/geometry/units.hpp"

namespace cell {
namespace {

constexpr std::size_t kSolidCountMax = 100;

calib::Capsule capsule_from_json(const JsonValue& value, std::optional<int> only_frame, std::size_t number) {
  const JsonObject object = value.object({"name", "frame", "from_mm", "to_mm", "radius_mm"});
  calib::Capsule capsule;
  capsule.name = object.has("name") ? object.at("name").text() : "body " + std::to_string(number);
  if (only_frame && !object.has("frame")) {
    capsule.frame = *only_frame;
  } else {
    capsule.frame =
        object.at("frame").integer(only_frame.value_or(0), only_frame.value_or(calib::kFrameCount - 1));
  }
  capsule.from_m = object.at("from_mm").numbers<3>() * calib::kMetresPerMillimetre;
  capsule.to_m = object.at("to_mm").numbers<3>() * calib::kMetresPerMillimetre;
  capsule.radius_m = object.metres("radius", kPositive);
  return capsule;
}

}  // namespace

Eigen::Isometry3d pose_of_trsf_angles(const Eigen::Vector3d& position_m, const Eigen::Vector3d& angles_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(position_m);
  pose.rotate(Eigen::AngleAxisd(angles_rad.x(), Eigen::Vector3d::UnitX()));
  pose.rotate(Eigen::AngleAxisd(angles_rad.y(), Eigen::Vector3d::UnitY()));
  pose.rotate(Eigen::AngleAxisd(angles_rad.z(), Eigen::Vector3d::UnitZ()));
  return pose;
}

Eigen::Isometry3d pose_from_json(const JsonObject& object) {
  return pose_of_trsf_angles(object.at("position_mm").numbers<3>() * calib::kMetresPerMillimetre,
                             object.at("rotation_deg").numbers<3>() * calib::kRadiansPerDegree);
}

calib::Box box_from_json(const JsonValue& value) {
  const JsonObject object = value.object({"name", "min_mm", "max_mm"});
  calib::Box box;
  box.name = object.at("name").text();
  box.min_m = object.at("min_mm").numbers<3>() * calib::kMetresPerMillimetre;
  box.max_m = object.at("max_mm").numbers<3>() * calib::kMetresPerMillimetre;
  if ((box.min_m.array() >= box.max_m.array()).any()) {
    value.fail("min_mm is not below max_mm on every axis; exchange or correct them");
  }
  return box;
}

std::vector<calib::Box> boxes_from_json(const JsonValue& value) {
  std::vector<calib::Box> boxes;
  for (const JsonValue& item : value.items(0, kSolidCountMax)) boxes.push_back(box_from_json(item));
  return boxes;
}

std::vector<calib::Capsule> capsules_from_json(const JsonValue& value, std::optional<int> only_frame) {
  std::vector<calib::Capsule> capsules;
  for (const JsonValue& item : value.items(0, kSolidCountMax)) {
    capsules.push_back(capsule_from_json(item, only_frame, capsules.size() + 1));
  }
  return capsules;
}

}  // namespace cell
