#include "config/identification_problem.hpp"

#include "calib_core/estimation/column_choice.hpp"
#include "config/touched_places.hpp"

namespace cell {

calib::IdentificationProblem identification_problem(const Cell& cell, const Recipe& recipe, int in) {
  calib::IdentificationProblem problem{.nominal = cell.arm.model,
                                       .artefact = calib::make_artefact(artefact_knowledge(cell, recipe, in)),
                                       .touch_noise_m = cell.touch_noise_m,
                                       .tolerances = prior_tolerances(cell),
                                       .nongeometric_std = cell.arm.nongeometric_std,
                                       .gear_std_rad = cell.arm.gears.std_rad(),
                                       .gear_lag_std_rad = cell.arm.gears.lag_std_rad(),
                                       .stop_std_rad = cell.arm.gears.repeatability_rad};
  problem.attainable = calib::attainable_parameters(problem, recipe.identification.identifiability);
  return problem;
}

}  // namespace cell
