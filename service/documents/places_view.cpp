#include "service/documents/places_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/base/json_figures.hpp"
#include "service/run/moved_cell.hpp"

namespace cell {
namespace {

using calib::degrees_from_radians;
using calib::mm_from_metres;

Json millimetres(const Eigen::Vector3d& vector_m) {
  return {mm_from_metres(vector_m.x()), mm_from_metres(vector_m.y()), mm_from_metres(vector_m.z())};
}

Json box_json(const calib::Box& box) {
  return {{"name", box.name}, {"min_mm", millimetres(box.min_m)}, {"max_mm", millimetres(box.max_m)}};
}

/// The two frames as the arm's file has them, without what stays.
Json frames_json(const calib::KinematicModel& model) {
  const calib::LinkParameters& base = model.links[0];
  const calib::LinkParameters& first = model.links[1];
  return {{{"j", 0}, {"theta_rad", base.theta_rad}, {"r_mm", mm_from_metres(base.r_m)}},
          {{"j", 1},
           {"alpha_rad", first.alpha_rad},
           {"d_mm", mm_from_metres(first.d_m)},
           {"theta_offset_rad", first.theta_rad},
           {"r_mm", mm_from_metres(first.r_m)},
           {"beta_rad", first.beta_rad}}};
}

Json place_json(const Cell& cell, const PlaceFinding& finding) {
  const Cell there = with_block_at(cell, finding.place);
  Json keep_out_boxes = Json::array();
  for (const calib::Box& box : there.keep_out_boxes) keep_out_boxes.push_back(box_json(box));
  const PlaceFigures figures = finding.figures.value_or(PlaceFigures{});
  const auto known = [&](double value) { return finding.figures ? number(value) : Json(nullptr); };
  return {{"shift_mm", millimetres(finding.place.shift_m)},
          {"yaw_deg", degrees_from_radians(finding.place.yaw_rad)},
          {"present", finding.present},
          {"feasible", finding.figures.has_value()},
          {"fully_planned", finding.fully_planned},
          {"reason", finding.figures ? Json(nullptr) : Json(finding.reason)},
          {"workspace_box_rms_mm", number_mm(figures.workspace_box_rms_m)},
          {"joint_ranges_rms_mm", number_mm(figures.joint_ranges_rms_m)},
          {"condition_number", known(figures.condition_number)},
          {"duration_s", known(figures.duration_s)},
          {"touch_count", finding.figures ? Json(figures.touch_count) : Json(nullptr)},
          {"frames", frames_json(there.arm.model)},
          {"keep_out_boxes", keep_out_boxes},
          {"workspace_box", box_json(there.workspace_box)}};
}

}  // namespace

std::string places_document(const Cell& cell, const Recipe& recipe,
                            const std::vector<PlaceFinding>& findings) {
  Json places = Json::array();
  for (const PlaceFinding& finding : findings) places.push_back(place_json(cell, finding));
  return text_of(
      {{"schema", "touchcal/places/1"}, {"cell", cell.name}, {"recipe", recipe.name}, {"places", places}});
}

}  // namespace cell
