#include "service/documents/internal/geometry_json.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/collision.hpp"

namespace cell {

using calib::mm_from_metres;

Json vector_mm_json(const Eigen::Vector3d& vector_m) {
  return {mm_from_metres(vector_m.x()), mm_from_metres(vector_m.y()), mm_from_metres(vector_m.z())};
}

Json box_json(const calib::Box& box) {
  return {{"name", box.name},
          {"min_mm", vector_mm_json(box.min_m.array() - box.round_m)},
          {"max_mm", vector_mm_json(box.max_m.array() + box.round_m)}};
}

Json joints_deg_json(const calib::JointVector& joints_rad) {
  Json joints = Json::array();
  for (const double joint_rad : joints_rad) joints.push_back(calib::degrees_from_radians(joint_rad));
  return joints;
}

Json joints_deg_json(const cs8::JointsMicrodeg& joints) {
  Json degrees = Json::array();
  for (const std::int32_t joint : joints) degrees.push_back(joint / 1e6);
  return degrees;
}

}  // namespace cell
