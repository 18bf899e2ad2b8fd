#include "calib_core/uncertainty/touch_patterns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "calib_core/uncertainty/left_out_effects.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr double kTiltStdMetres = 2e-6, kLobesStdMetres = 1e-6, kLagStdRad = 1e-5;
/// Their places among the patterns: the lags, the tilt, the two lobes.
constexpr int kTilt = 6, kLobes = 7, kPatterns = 9;

IdentificationProblem touched_with_patterns() {
  UniformChance chance(3);
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(5));
  problem.touches = drawn::touches(drawn::draw_truth(problem, chance), {.count = 40}, chance);
  problem.artefact.std_sideways_m = {kTiltStdMetres, kLobesStdMetres, kLobesStdMetres};
  problem.gear_lag_std_rad.setConstant(kLagStdRad);
  problem.nominal.gains[4] = -0.5;
  return problem;
}

std::vector<std::string> names_of(const IdentificationProblem& problem) {
  std::vector<std::string> names;
  for (const TouchPattern& pattern : touch_patterns(problem)) names.emplace_back(pattern.source);
  return names;
}

TEST(TouchPatterns, AreTheLagOfEachJointThenWhatIsNotKnownOfTheProbe) {
  IdentificationProblem problem = touched_with_patterns();
  std::vector<std::string> all(6, "backlash");
  all.insert(all.end(), {"pretravel_tilt", "lobes", "lobes"});
  EXPECT_EQ(names_of(problem), all);
  EXPECT_EQ(touch_patterns(problem)[0].std, kLagStdRad);
  EXPECT_EQ(touch_patterns(problem)[kTilt].std, kTiltStdMetres);
  problem.artefact.std_sideways_m.x() = 0.0;
  problem.gear_lag_std_rad.setZero();
  EXPECT_THAT(names_of(problem), testing::ElementsAre("lobes", "lobes"));
  problem.artefact.std_sideways_m.setZero();
  EXPECT_TRUE(touch_patterns(problem).empty());
}

// Against differences of the distance of a touch: with another probe, and with a joint behind its drive.
TEST(TouchPatterns, DisplaceATouchByWhatItsDistanceChanges) {
  const IdentificationProblem problem = touched_with_patterns();
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  std::vector<std::size_t> touches(problem.touches.size());
  std::iota(touches.begin(), touches.end(), std::size_t{0});
  LeastSquares fit(problem, {.prior = true}, columns, touches);
  const Estimate nominal;
  fit.linearise(nominal);
  const Eigen::MatrixXd displaced = pattern_displacements(problem, fit, nominal);
  ASSERT_EQ(displaced.cols(), kPatterns);
  const auto& planes = problem.artefact.contact_planes;
  const Eigen::VectorXd before = signed_distances_m(problem.nominal, planes, problem.touches);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < kPatterns; ++k) {
    std::vector<Touch> lagging = problem.touches;
    std::vector<ContactSurface> probed = planes;
    for (ContactSurface& plane : probed) {
      if (k == kTilt) plane.sideways.tilt_m = kStep;
      if (k >= kLobes) plane.sideways.lobes_m = kStep;
      if (k == kLobes + 1) plane.sideways.lobe_direction_rad = radians_from_degrees(30.0);  // the sine
    }
    for (Touch& touch : lagging) {
      if (k >= kJointCount) continue;
      const Chain chain = forward_chain(problem.nominal, touch.joints);
      const Eigen::Vector3d outward = planes[static_cast<std::size_t>(touch.face)].outward;
      touch.joints[k] -= kStep * search_directions(problem.nominal, chain, outward)[k];
    }
    const Eigen::VectorXd slope =
        (signed_distances_m(problem.nominal, probed, lagging) - before) / kStep * fit.weights()[0];
    EXPECT_LT((displaced.col(k) - slope).cwiseAbs().maxCoeff(), 1e-4 * fit.weights()[0]) << k;
  }
}

}  // namespace
}  // namespace calib
