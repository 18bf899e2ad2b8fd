#include "calib_core/uncertainty/uncertainty_budget.hpp"

namespace calib {

UncertaintyBudget in_arm_frame(const UncertaintyBudget& budget) {
  UncertaintyBudget result;
  result.noise_m = budget.noise_m;
  result.degrees_of_freedom = budget.degrees_of_freedom;
  result.coverage_factor = budget.coverage_factor;
  result.identified = budget.identified;
  result.held = budget.held;
  result.unseen = budget.unseen;
  result.of_posture = budget.of_posture;
  result.unseen_without_tolerance = budget.unseen_without_tolerance;
  result.unknown_directions = budget.unknown_directions;
  for (int i = 0; i < kArmParameterCount; ++i) {
    if (!is_place_error(i)) continue;
    for (ArmMatrix* part : {&result.identified, &result.held, &result.unseen}) {
      part->row(i).setZero();
      part->col(i).setZero();
    }
    result.unknown_directions.row(i).setZero();
  }
  return result;
}

}  // namespace calib
