#pragma once

#include <optional>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"

namespace calib {

/// The same touches in the order in which they are made: those to fit before those held out; never the same
/// face twice in a row while another has touches left, and each face's share done at any time about what it
/// is of all. The first ones, a few more than there are identifiable parameters, are those that together tell
/// most, weighed against the way to them; the others follow so that the whole way, from the park posture and
/// back, is short in time.
std::vector<PlannedTouch> put_in_order(const PlanningProblem& problem, std::vector<PlannedTouch> touches);

/// The touches in the order given, with their ways and predicted times (PlannedTouch::via, travel_s, touch_s;
/// TouchPlan::park_via, park_s). A way keeps the smaller predicted miss of its two touches, the problem's
/// nominal one at a touch that has none. Nothing when there is no way, which does not happen with touches
/// made by make_touch.
std::optional<TouchPlan> find_ways(const PlanningProblem& problem, std::vector<PlannedTouch> touches);

}  // namespace calib
