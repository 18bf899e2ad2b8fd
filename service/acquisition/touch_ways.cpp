#include "service/acquisition/touch_ways.hpp"

namespace cell {
namespace {

/// A run that reached the accuracy it was asked for leaves out the touches that it would still fit; returns
/// how many.
int drop_when_good_enough(Run& run) {
  return run.meets_accuracy_goal() ? run.drop_fit_touches(run.touches_made() + 1) : 0;
}

/// From the clear posture of the touch under way.
std::optional<PreparedTouch> prepare_behind(TouchPreparation& preparation, Run& run,
                                            const ReferenceMonitor& reference) {
  const std::size_t behind = run.touches_made() + 1;
  preparation.look_ahead(run, behind);
  const bool is_due = reference.is_due(run.touches_done() + 1, !run.planned_here(behind));
  if (!is_due || !reference.aimed()) return std::nullopt;
  return preparation.prepare(*reference.aimed(), preparation.made()->touch.clear_joints);
}

}  // namespace

WayOfPlan find_way_of_plan(TouchPreparation& preparation, Run& run, const calib::JointVector& from) {
  // An aimed touch is kept after a hold or a restart; only the path to it is planned again.
  if (preparation.reroute_from(from, *run.next())) return {.is_there = true};
  preparation.add_contacts(run);
  if (preparation.prepare_next(run, from)) return {.is_there = true};
  return {.can_leave = preparation.can_leave(from)};
}

WayBesidePlan find_way_beside_plan(const TouchPreparation& preparation, const calib::AimedTouch& aimed,
                                   const calib::JointVector& from) {
  WayBesidePlan way{.touch = preparation.prepare(aimed, from)};
  way.can_leave = way.touch || preparation.can_leave(from);
  return way;
}

LookAhead look_ahead(TouchPreparation& preparation, Run& run, const ReferenceMonitor& reference) {
  preparation.add_contacts(run);
  const int dropped = drop_when_good_enough(run);
  return {.to_reference = prepare_behind(preparation, run, reference), .dropped = dropped};
}

bool look_ahead_from_reference(TouchPreparation& preparation, Run& run, const calib::JointVector& from) {
  const calib::PlannedTouch* next = run.next_here();
  if (!next) return false;
  if (preparation.reroute_from(from, *next)) return true;
  preparation.add_contacts(run);  // one that was kept late may be why there is nothing to take up
  return preparation.prepare_next(run, from);
}

AimBehindContact aim_behind(TouchPreparation& preparation, Run& run, const calib::Touch& touch,
                            const ReferenceMonitor& reference) {
  preparation.set_missed(false);
  AimBehindContact aim{.contradicted = preparation.add_ahead(run, touch)};
  aim.is_surprise = preparation.is_surprise(touch.joints);
  if (!aim.is_surprise) return aim;
  preparation.drop_next();
  if (!aim.contradicted) aim.to_reference = prepare_behind(preparation, run, reference);
  return aim;
}

}  // namespace cell
