#include "service/documents/places_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/documents/internal/geometry_json.hpp"
#include "service/run/moved_cell.hpp"

namespace cell {
namespace {

using calib::degrees_from_radians;
using calib::mm_from_metres;

/// The changed values of frames 0 and 1, as in the arm's file.
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

Json place_json(const Cell& cell, const PlaceCandidate& candidate) {
  const Cell there = with_block_displaced(cell, candidate.place);
  Json keep_out_boxes = Json::array();
  for (const calib::Box& box : there.keep_out_boxes) keep_out_boxes.push_back(box_json(box));
  const PlaceFigures figures = candidate.figures.value_or(PlaceFigures{});
  const auto known = [&](double value) { return candidate.figures ? number(value) : Json(nullptr); };
  return {{"shift_mm", vector_mm_json(candidate.place.shift_m)},
          {"yaw_deg", degrees_from_radians(candidate.place.yaw_rad)},
          {"present", candidate.present},
          {"feasible", candidate.figures.has_value()},
          {"fully_planned", candidate.fully_planned},
          {"reason", candidate.figures ? Json(nullptr) : Json(candidate.reason)},
          {"workspace_box_rms_mm", number_mm(figures.workspace_box_rms_m)},
          {"joint_ranges_rms_mm", number_mm(figures.joint_ranges_rms_m)},
          {"condition_number", known(figures.condition_number)},
          {"duration_s", known(figures.duration_s)},
          {"touch_count", candidate.figures ? Json(figures.touch_count) : Json(nullptr)},
          {"frames", frames_json(there.arm.model)},
          {"keep_out_boxes", keep_out_boxes},
          {"workspace_box", box_json(there.workspace_box)}};
}

}  // namespace

std::string places_document(const Cell& cell, const Recipe& recipe,
                            const std::vector<PlaceCandidate>& candidates) {
  Json places = Json::array();
  for (const PlaceCandidate& candidate : candidates) places.push_back(place_json(cell, candidate));
  return text_of(
      {{"schema", "touchcal/places/1"}, {"cell", cell.name}, {"recipe", recipe.name}, {"places", places}});
}

}  // namespace cell
