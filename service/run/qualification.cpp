#include "service/run/qualification.hpp"

namespace cell {

calib::QualificationProblem qualification_problem(const Cell& cell, const Verification& against) {
  const ProbeLimits& limits = cell.acceptance.probe;
  return {.nominal = cell.arm.model,
          .surfaces = calib::make_artefact(artefact_knowledge(cell)).contact_planes,
          .lengths = cell.block.lengths,
          .limits = {.scatter_max_m = limits.scatter_max_m.value_or(cell.touch_noise_m),
                     .run_out_max_m = limits.run_out_max_m,
                     .lobes_max_m = limits.lobes_max_m,
                     .step_max_m = limits.step_max_m,
                     .guarded = cell.acceptance.guarded},
          .record = against.record ? &*against.record : nullptr,
          .std_growth = against.place.std_growth};
}

}  // namespace cell
