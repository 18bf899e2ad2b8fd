#include "calib_core/uncertainty/distance_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr int kFaces = 5;
constexpr int kHeldOutOnAFace = 10;

/// Held-out touches on every face after the fitted ones; cells drawn within what is known of them.
IdentificationResult calibrated(int seed, int fitted) {
  UniformChance chance(static_cast<std::uint64_t>(seed));
  IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(kFaces));
  const drawn::Truth truth = drawn::draw_truth(problem, chance);
  problem.touches = drawn::touches(truth, {.count = fitted + kFaces * kHeldOutOnAFace}, chance);
  for (std::size_t i = static_cast<std::size_t>(fitted); i < problem.touches.size(); ++i)
    problem.touches[i].role = TouchRole::kHeldOut;
  return identify(problem, {.robust = false});
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

TEST(MeanDistance, OfFittedTouchesHasNone) {
  for (const FaceDistances& face : calibrated(1, 40).distances)
    EXPECT_EQ(face.calibrated_mean_std_m.has_value(), face.role != TouchRole::kFit);
}

}  // namespace
}  // namespace calib
