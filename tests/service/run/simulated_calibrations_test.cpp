#include "service/run/simulated_calibrations.hpp"

#include <gtest/gtest.h>

#include "config/identification_problem.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

constexpr int kDraws = 100;

class SimulatedCalibrations : public ::testing::Test {
 protected:
  SimulatedCalibrations() {
    problem_ = identification_problem(edf(), recipe_);
    problem_.touches = table3_touches();
    result_ = calib::identify(problem_, recipe_.identification);
  }
  std::optional<calib::MonteCarloFigures> simulate(int count, int threads,
                                                   const DrawProgress& progress = {}) {
    return simulate_calibrations(TipRegions(edf()), problem_, recipe_.identification, result_, count, threads,
                                 progress);
  }

  const Recipe& recipe_ = edf().recipes.at("edf-25");
  calib::IdentificationProblem problem_;
  calib::IdentificationResult result_;
};

TEST_F(SimulatedCalibrations, GiveTheSameFiguresOnAnyNumberOfThreads) {
  const calib::MonteCarloFigures alone = simulate(kDraws, 1).value();
  EXPECT_EQ(alone.count, kDraws);
  EXPECT_EQ(alone.converged, kDraws);
  for (const int threads : {2, 3, 7}) {
    const calib::MonteCarloFigures together = simulate(kDraws, threads).value();
    EXPECT_EQ(together.box_rms_m, alone.box_rms_m) << threads;
    EXPECT_EQ(together.box_p95_m, alone.box_p95_m) << threads;
    EXPECT_EQ(together.joint_ranges_rms_m, alone.joint_ranges_rms_m) << threads;
    EXPECT_EQ(together.linear_over_monte_carlo, alone.linear_over_monte_carlo) << threads;
  }
}

TEST_F(SimulatedCalibrations, TellHowManyAreDone) {
  std::vector<int> told;
  simulate(kDraws, 1, [&told](int done) { told.push_back(done); });
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), kDraws);
}

TEST_F(SimulatedCalibrations, HaveNoFigureWhereAnErrorOfUnknownSizeMatters) {
  const int r1 = *calib::error_parameter_index("r1");
  result_.uncertainty->unseen_without_tolerance = {r1};
  result_.uncertainty->unknown_directions = calib::ArmVector::Unit(r1);
  const calib::MonteCarloFigures figures = simulate(kDraws, 2).value();
  EXPECT_EQ(figures.converged, kDraws);
  EXPECT_EQ(figures.box_rms_m, std::nullopt);
  EXPECT_EQ(figures.linear_over_monte_carlo, std::nullopt);
  EXPECT_EQ(figures.joint_ranges_rms_m, std::nullopt);
}

TEST_F(SimulatedCalibrations, AreNotMadeWithoutANoise) {
  result_.uncertainty.reset();
  EXPECT_EQ(simulate(kDraws, 2), std::nullopt);
}

}  // namespace
}  // namespace cell
