#include "service/documents/places_view.hpp"

#include "calib_core/geometry/units.hpp"
#include "config/moved_cell.hpp"
#include "service/documents/figures.hpp"

namespace cell {
namespace {

using calib::degrees_from_radians;
using calib::mm_from_metres;

std::array<double, 3> in_millimetres(const Eigen::Vector3d& vector_m) {
  return {mm_from_metres(vector_m.x()), mm_from_metres(vector_m.y()), mm_from_metres(vector_m.z())};
}

TipDocument::Box box_of(const calib::Box& box) {
  return {.name = box.name, .min_mm = in_millimetres(box.min_m), .max_mm = in_millimetres(box.max_m)};
}

/// The changed values of frames 0 and 1, as in the arm's file.
std::array<PlacesDocument::Frame, 2> frames_of(const calib::KinematicModel& model) {
  const calib::LinkParameters& base = model.links[0];
  const calib::LinkParameters& first = model.links[1];
  return {PlacesDocument::Frame{.j = 0, .theta_rad = base.theta_rad, .r_mm = mm_from_metres(base.r_m)},
          PlacesDocument::Frame{.j = 1,
                                .alpha_rad = first.alpha_rad,
                                .d_mm = mm_from_metres(first.d_m),
                                .theta_offset_rad = first.theta_rad,
                                .r_mm = mm_from_metres(first.r_m),
                                .beta_rad = first.beta_rad}};
}

PlacesDocument::Place block_pose_of(const Cell& cell, const PlaceCandidate& candidate) {
  const Cell there = with_block_displaced(cell, candidate.place);
  PlacesDocument::Place place{.shift_mm = in_millimetres(candidate.place.shift_m),
                              .yaw_deg = degrees_from_radians(candidate.place.yaw_rad),
                              .present = candidate.present,
                              .feasible = candidate.figures.has_value(),
                              .fully_planned = candidate.fully_planned,
                              .frames = frames_of(there.arm.model),
                              .workspace_box = box_of(there.workspace_box)};
  for (const calib::Box& box : there.keep_out_boxes) place.keep_out_boxes.push_back(box_of(box));
  if (!candidate.figures) {
    place.reason = candidate.reason;
    return place;
  }
  place.workspace_box_rms_mm = finite_mm(candidate.figures->workspace_box_rms_m);
  place.joint_ranges_rms_mm = finite_mm(candidate.figures->joint_ranges_rms_m);
  place.condition_number = finite(candidate.figures->condition_number);
  place.duration_s = finite(candidate.figures->duration_s);
  place.touch_count = candidate.figures->touch_count;
  return place;
}

}  // namespace

PlacesDocument places_of(const Cell& cell, const Recipe& recipe,
                         const std::vector<PlaceCandidate>& candidates) {
  PlacesDocument document{.cell = cell.name, .recipe = recipe.name};
  for (const PlaceCandidate& candidate : candidates)
    document.places.push_back(block_pose_of(cell, candidate));
  return document;
}

}  // namespace cell
