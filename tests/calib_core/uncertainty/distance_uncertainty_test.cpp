#include "calib_core/uncertainty/distance_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/left_out_effects.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr int kFaces = 5;
constexpr int kHeldOutOnAFace = 10;

/// Held-out touches on every face after the fitted ones; cells drawn within what is known of them.
IdentificationProblem touched(int seed, int fitted) {
  UniformChance chance(static_cast<std::uint64_t>(seed));
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(kFaces));
  const drawn::Truth truth = drawn::draw_truth(problem, chance);
  problem.touches = drawn::touches(truth, {.count = fitted + kFaces * kHeldOutOnAFace}, chance);
  for (std::size_t i = static_cast<std::size_t>(fitted); i < problem.touches.size(); ++i)
    problem.touches[i].role = TouchRole::kHeldOut;
  return problem;
}

IdentificationResult calibrated(int seed, int fitted) {
  return identify(touched(seed, fitted), {.robust = false});
}

TEST(MeanDistance, ScattersAsItsStandardDeviationSays) {
  double sum = 0.0;
  int count = 0;
  for (int seed = 1; seed <= 60; ++seed) {
    const IdentificationResult result = calibrated(seed, 40);
    ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    for (const FaceDistances& face : result.distances) {
      if (face.role != TouchRole::kHeldOut) continue;
      ASSERT_TRUE(face.calibrated_mean_std_m);
      EXPECT_GT(*face.calibrated_mean_std_m, result.uncertainty->noise_m / std::sqrt(kHeldOutOnAFace));
      sum += std::pow(face.calibrated_mean_m / *face.calibrated_mean_std_m, 2);
      ++count;
    }
  }
  ASSERT_EQ(count, 60 * kFaces);
  EXPECT_NEAR(sum / count, 1.0, 0.25);  // a variance of 300 figures, five of a cell correlated
}

TEST(MeanDistance, IsKnownTheBetterTheMoreTouchesWereFitted) {
  const auto first_std = [](const IdentificationResult& result) {
    for (const FaceDistances& face : result.distances)
      if (face.calibrated_mean_std_m) return *face.calibrated_mean_std_m;
    return 0.0;
  };
  EXPECT_GT(first_std(calibrated(1, 40)), 1.2 * first_std(calibrated(1, 200)));
}

TEST(MeanDistance, HasTheNoiseThatItsTouchesHaveOfTheirOwn) {
  const IdentificationOptions options{.robust = false, .measure_noise = false};
  constexpr double kFactor = 10.0;
  IdentificationProblem problem = touched(1, 60);
  const IdentificationResult alike = identify(problem, options);
  for (Touch& touch : problem.touches) {
    if (touch.role == TouchRole::kHeldOut) touch.deviation_m = kFactor * problem.touch_noise_m;
  }
  const IdentificationResult unsure = identify(problem, options);
  const double more = (kFactor * kFactor - 1.0) * std::pow(problem.touch_noise_m, 2) / kHeldOutOnAFace;
  for (std::size_t i = 0; i < alike.distances.size(); ++i) {
    if (alike.distances[i].role != TouchRole::kHeldOut) continue;
    EXPECT_NEAR(std::pow(unsure.distances[i].calibrated_mean_std_m.value(), 2) -
                    std::pow(alike.distances[i].calibrated_mean_std_m.value(), 2),
                more, 1e-6 * more);
  }
}

TEST(MeanDistance, OfFittedTouchesHasNone) {
  for (const FaceDistances& face : calibrated(1, 40).distances)
    EXPECT_EQ(face.calibrated_mean_std_m.has_value(), face.role != TouchRole::kFit);
}

// Joints that lag displace the held-out touches as they displace the fitted ones, which bends the arm so that
// most of it is not seen.
TEST(MeanDistance, CountsALagWhereItDisplacesTheTouchesAndWhereItBendsTheArm) {
  constexpr double kLagRad = 1e-4;
  const IdentificationOptions options{.robust = false, .hold_weak = false};
  IdentificationProblem problem = touched(1, 60);
  const IdentificationResult without = identify(problem, options);
  problem.gear_lag_std_rad.setConstant(kLagRad);
  const IdentificationResult with = identify(problem, options);
  std::vector<double> moved_squared(with.distances.size(), 0.0);
  for (int joint = 0; joint < kJointCount; ++joint) {
    IdentificationProblem lagging = problem;
    for (Touch& touch : lagging.touches) {
      const ContactSurface& plane = problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)];
      const Chain chain = forward_chain(without.calibrated, touch.joints);
      touch.joints[joint] += kLagRad * search_directions(without.calibrated, chain, plane.outward)[joint];
    }
    const IdentificationResult lagged = identify(lagging, options);
    for (std::size_t i = 0; i < moved_squared.size(); ++i) {
      moved_squared[i] +=
          std::pow(lagged.distances[i].calibrated_mean_m - without.distances[i].calibrated_mean_m, 2);
    }
  }
  for (std::size_t i = 0; i < moved_squared.size(); ++i) {
    if (with.distances[i].role == TouchRole::kFit) continue;
    const double of_lag = std::pow(with.distances[i].calibrated_mean_std_m.value(), 2) -
                          std::pow(without.distances[i].calibrated_mean_std_m.value(), 2);
    EXPECT_NEAR(std::sqrt(of_lag), std::sqrt(moved_squared[i]), 0.1 * std::sqrt(moved_squared[i]) + 2e-7)
        << i;
  }
}

}  // namespace
}  // namespace calib
