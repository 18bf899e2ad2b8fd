#include "service/run/qualification.hpp"

#include <gtest/gtest.h>

#include "service/run/block_temperature.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

TEST(QualificationOfACell, HasTheLimitsOfTheFileAndTheCellsNoiseForTheScatter) {
  Cell cell = edf();
  cell.acceptance.probe = {};
  const auto alone = qualification_alone("none was accepted");
  calib::QualificationProblem problem = qualification_problem(cell, *alone);
  EXPECT_EQ(problem.limits.scatter_max_m, cell.touch_noise_m);
  EXPECT_FALSE(problem.limits.run_out_max_m || problem.limits.lobes_max_m || problem.limits.step_max_m);
  EXPECT_EQ(problem.record, nullptr);
  cell.acceptance.probe = {
      .scatter_max_m = 1e-6, .run_out_max_m = 2e-6, .lobes_max_m = 3e-6, .step_max_m = 4e-6};
  problem = qualification_problem(cell, *alone);
  EXPECT_EQ(problem.limits.scatter_max_m, 1e-6);
  EXPECT_EQ(problem.limits.run_out_max_m, 2e-6);
  EXPECT_EQ(problem.limits.lobes_max_m, 3e-6);
  EXPECT_EQ(problem.limits.step_max_m, 4e-6);
}

TEST(QualificationOfACell, TakesTheBlockAsWarmAsItIs) {
  Cell cell = edf();
  cell.block.thermal_expansion_per_k = 2.4e-5;
  const auto alone = qualification_alone("none was accepted");
  const auto offset_m = [&](double celsius) {
    const Cell warm =
        with_block_temperature(cell, BlockTemperature{.celsius = celsius, .std_k = 1.0, .measured_at = {}});
    return qualification_problem(warm, *alone).surfaces.front().offset_m;
  };
  EXPECT_NEAR(offset_m(30.0) - offset_m(20.0), 10.0 * 2.4e-5 * cell.block.faces.front().plane.offset_m, 1e-9);
}

}  // namespace
}  // namespace cell
