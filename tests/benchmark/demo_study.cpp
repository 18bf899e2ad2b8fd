#include "tests/benchmark/demo_study.hpp"

#include "calib_core/numerics/uniform_chance.hpp"
#include "config/identification_problem.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace bench {

DemoStudy demo_study(bool rigid) {
  constexpr int kFittedPerFace = 20;
  constexpr int kHeldOutPerFace = 10;
  const cell::Cell cell = rigid ? calib::figures::rigid_cell("demo") : calib::figures::shipped_cell("demo");
  const cell::Recipe& recipe = cell.recipes.at("best");
  DemoStudy study{cell::identification_problem(cell, recipe), recipe.identification};
  calib::UniformChance chance(1);
  const auto face_count = static_cast<int>(cell.block.faces.size());
  std::vector<calib::Touch> touches =
      calib::figures::even_touches(cell, face_count, kFittedPerFace + kHeldOutPerFace, chance);
  for (std::size_t i = static_cast<std::size_t>(face_count * kFittedPerFace); i < touches.size(); ++i)
    touches[i].role = calib::TouchRole::kHeldOut;
  const calib::figures::Truth truth{
      calib::apply(cell.arm.model, calib::figures::draw_errors(study.problem.tolerances, chance)),
      study.problem.artefact.contact_planes};
  study.problem.touches =
      calib::figures::captured(truth, std::move(touches), study.problem.touch_noise_m, chance);
  return study;
}

int unknown_count(const calib::IdentificationResult& result) {
  return static_cast<int>(result.identifiable.columns.size() + result.nongeometric.size()) +
         static_cast<int>(result.artefact_errors.size());
}

}  // namespace bench
