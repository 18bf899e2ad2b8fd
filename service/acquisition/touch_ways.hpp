#pragma once

#include <optional>

#include "service/acquisition/reference_monitor.hpp"
#include "service/acquisition/touch_preparation.hpp"
#include "service/run/run.hpp"

/// What is computed from one touch to the next, on copies of the preparation and of the run beside the link:
/// see RunComputation::prepared(). Pure functions, milliseconds.
namespace cell {

/// The way to the next touch of the plan, which is in the preparation then.
struct WayOfPlan {
  bool is_there = false;
  bool can_leave = false;  // where there is none
};
WayOfPlan find_way_of_plan(TouchPreparation& preparation, Run& run, const calib::JointVector& from);

/// The way to a touch outside the plan.
struct WayBesidePlan {
  std::optional<PreparedTouch> touch;
  bool can_leave = false;  // where there is none
};
WayBesidePlan find_way_beside_plan(const TouchPreparation& preparation, const calib::AimedTouch& aimed,
                                   const calib::JointVector& from);

/// What comes behind the touch under way, beside that of the plan, which is in the preparation.
struct LookAhead {
  std::optional<PreparedTouch> to_reference;  // where the reference place is touched next
  int dropped = 0;                            // touches of the plan, which the run does without
};
LookAhead look_ahead(TouchPreparation& preparation, Run& run, const ReferenceMonitor& reference);
/// The same behind a touch of the reference place: the way from there to the next touch of the plan. False
/// when there is none.
bool look_ahead_from_reference(TouchPreparation& preparation, Run& run, const calib::JointVector& from);

/// What a contact changes, which is the run's next touch once it is stored. What comes behind it was aimed
/// before it was known and is aimed again where the contact is a surprise.
struct AimBehindContact {
  bool contradicted = false;  // by the others: it is made again while the arm is there
  bool is_surprise = false;
  std::optional<PreparedTouch> to_reference;  // of a surprise, as LookAhead::to_reference
};
AimBehindContact aim_behind(TouchPreparation& preparation, Run& run, const calib::Touch& touch,
                            const ReferenceMonitor& reference);

}  // namespace cell
