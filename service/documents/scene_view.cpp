#include "service/documents/scene_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/documents/internal/geometry_json.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

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
                    {"from_mm", vector_mm_json(body.from_m)},
                    {"to_mm", vector_mm_json(body.to_m)},
                    {"radius_mm", mm_from_metres(body.radius_m)}});
  }
  return list;
}

Json holes_json(const calib::Box& box) {
  Json list = Json::array();
  for (const calib::Hole& hole : box.holes) {
    list.push_back({{"center_mm", vector_mm_json(hole.center_m)},
                    {"axis", {hole.axis.x(), hole.axis.y(), hole.axis.z()}},
                    {"radius_mm", mm_from_metres(hole.radius_m)}});
  }
  return list;
}

}  // namespace

Json scene_json(const Cell& cell) {
  Json solids = Json::array();
  for (const calib::Box& box : cell.block.solids) {
    solids.push_back(box_json(box));
    solids.back()["holes"] = holes_json(box);
  }
  return {{"frames", frames_json(cell.arm.model)},
          {"gains", cell.arm.model.gains},
          {"arm_bodies", bodies_json(cell.arm.bodies)},
          {"probe_bodies", bodies_json(cell.probe.bodies)},
          {"solids", solids},
          {"park_joints_deg", joints_deg_json(cell.park_joints)}};
}

std::string joints_document(const std::optional<cs8::State>& state, const Status& status) {
  return text_of({{"joints_deg", state ? joints_deg_json(state->joints) : Json(nullptr)},
                  {"data_age_ms", value_or_null(status.data_age_ms)},
                  {"sequence", status.sequence},
                  {"instance_id", status.instance_id}});
}

}  // namespace cell
