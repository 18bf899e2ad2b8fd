#include "service/documents/scene_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"

namespace cell {
namespace {

using calib::degrees_from_radians;
using calib::mm_from_metres;

Json vector_mm(const Eigen::Vector3d& point_m) {
  return {mm_from_metres(point_m.x()), mm_from_metres(point_m.y()), mm_from_metres(point_m.z())};
}

/// As the arm's file has them: at a joint, theta is the offset.
Json frames_json(const calib::KinematicModel& model) {
  Json frames = Json::array();
  for (const calib::LinkParameters& link : model.links) {
    frames.push_back({{"alpha_rad", link.alpha_rad},
                      {"d_mm", mm_from_metres(link.d_m)},
                      {"theta_rad", link.theta_rad},
                      {"r_mm", mm_from_metres(link.r_m)},
                      {"beta_rad", link.beta_rad}});
  }
  return frames;
}

Json bodies_json(const std::vector<calib::Capsule>& bodies) {
  Json list = Json::array();
  for (const calib::Capsule& body : bodies) {
    list.push_back({{"name", body.name},
                    {"frame", body.frame},
                    {"from_mm", vector_mm(body.from_m)},
                    {"to_mm", vector_mm(body.to_m)},
                    {"radius_mm", mm_from_metres(body.radius_m)}});
  }
  return list;
}

}  // namespace

Json scene_json(const Cell& cell) {
  Json solids = Json::array();
  for (const calib::Box& box : cell.block.solids) {
    solids.push_back(
        {{"name", box.name}, {"min_mm", vector_mm(box.min_m)}, {"max_mm", vector_mm(box.max_m)}});
  }
  Json park = Json::array();
  for (const double joint_rad : cell.park_joints) park.push_back(degrees_from_radians(joint_rad));
  return {{"frames", frames_json(cell.arm.model)},
          {"gains", cell.arm.model.gains},
          {"arm_bodies", bodies_json(cell.arm.bodies)},
          {"probe_bodies", bodies_json(cell.probe.bodies)},
          {"solids", solids},
          {"park_joints_deg", park}};
}

std::string joints_document(const std::optional<cs8::State>& told, const Status& status) {
  Json joints = nullptr;
  if (told) {
    joints = Json::array();
    for (const std::int32_t microdeg : told->joints) joints.push_back(microdeg / 1e6);
  }
  return text_of({{"joints_deg", joints},
                  {"data_age_ms", status.data_age_ms ? Json(*status.data_age_ms) : Json(nullptr)},
                  {"sequence", status.sequence},
                  {"instance_id", status.instance_id}});
}

}  // namespace cell
