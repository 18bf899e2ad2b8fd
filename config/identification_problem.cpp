#include "config/identification_problem.hpp"

#include "calib_core/estimation/column_choice.hpp"

namespace cell {

calib::IdentificationProblem identification_problem(const Cell& cell, const Recipe& recipe) {
  calib::IdentificationProblem problem{.nominal = cell.arm.model,
                                       .artefact = calib::make_artefact(artefact_knowledge(cell)),
                                       .touch_noise_m = cell.touch_noise_m,
                                       .tolerances = prior_tolerances(cell),
                                       .std_compliance_rad_per_nm = cell.arm.std_compliance_rad_per_nm};
  problem.attainable = calib::attainable_parameters(problem, recipe.identification.identifiability);
  return problem;
}

}  // namespace cell
