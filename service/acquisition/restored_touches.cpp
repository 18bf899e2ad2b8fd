#include "service/acquisition/restored_touches.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>

#include "calib_core/geometry/units.hpp"
#include "config/touched_places.hpp"
#include "service/run/touch_command.hpp"

namespace cell {
namespace {

/// How far a contact may be from the planned one: the search reaches so far, and may be aimed so far beside.
double reach_m(const Cell& cell, const Recipe& recipe, const calib::PlannedTouch& planned) {
  const auto tip_m = [&](const calib::JointVector& joints) -> Eigen::Vector3d {
    return calib::forward_kinematics(cell.arm.model, joints).translation();
  };
  const double search_m = (tip_m(planned.search_end_joints) - tip_m(planned.approach_joints)).norm();
  const int place = place_of_face(cell.block, recipe, planned.face);
  return search_m + cell.face_error_m() + found_within_m(cell.block, recipe, place);
}

std::optional<std::string> why_beside(const Cell& cell, const Recipe& recipe,
                                      const calib::PlannedTouch& planned, const StoredTouch& touch) {
  const Eigen::Isometry3d stored = calib::forward_kinematics(cell.arm.model, from_wire(touch.joints));
  const Eigen::Isometry3d wanted = calib::forward_kinematics(cell.arm.model, planned.joints);
  const double off_m = (stored.translation() - wanted.translation()).norm();
  const double turn_rad = Eigen::AngleAxisd(wanted.rotation().transpose() * stored.rotation()).angle();
  if (off_m <= reach_m(cell, recipe, planned) && turn_rad <= kRestoredTurnMaxRad) return std::nullopt;
  return fmt::format("touch {} is {:.1f} mm and {:.1f} degrees from the one that was planned", touch.number,
                     calib::mm_from_metres(off_m), calib::degrees_from_radians(turn_rad));
}

}  // namespace

std::optional<std::string> why_no_touches_of(const Cell& cell, const Recipe& recipe,
                                             const std::vector<StoredTouch>& touches) {
  const int planes = place_count(recipe) * faces_per_place(cell.block, recipe);
  int expected = 0;
  for (const StoredTouch& touch : touches) {
    if (touch.number != ++expected)
      return fmt::format("touch {} is missing, and touch {} is there", expected, touch.number);
    if (touch.plane < 1 || touch.plane > planes)
      return fmt::format("touch {} is on plane {}, which the block has not", touch.number, touch.plane);
  }
  return std::nullopt;
}

std::optional<std::string> why_not_of_plan(const Cell& cell, const Run& run, bool by_hand) {
  for (std::size_t i = 0; i < run.touches().size(); ++i) {
    const StoredTouch& touch = run.touches()[i];
    const calib::PlannedTouch* planned = run.planned(i);
    if (!planned) return fmt::format("touch {} is beyond the plan", touch.number);
    if (touch.plane != planned->face + 1)
      return fmt::format("touch {} is on plane {} and was planned on plane {}", touch.number, touch.plane,
                         planned->face + 1);
    if (touch.role != planned->role)
      return fmt::format("touch {} has another role than the planned one", touch.number);
    if (by_hand) continue;
    if (auto why = why_beside(cell, run.recipe(), *planned, touch)) return why;
  }
  return std::nullopt;
}

}  // namespace cell
