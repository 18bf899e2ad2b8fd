#include "calib_core/uncertainty/scale_check.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// What a scale is said to come from; how often it is warned of is in tests/figures/scale_test.
namespace calib {
namespace {

ScaleSource source_of(const ArtefactKnowledge& knowledge, const std::vector<int>& touched) {
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(51);
  const auto truth = drawn::draw_truth(problem, chance);
  problem.touches = drawn::touches(truth, {.count = 120, .faces = touched}, chance);
  const auto result = identify(problem, {.prior = false, .hold_weak = false});
  EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  return result.scale ? result.scale->source : ScaleSource::kPrior;
}

TEST(ScaleSource, IsTwoLengthsWhereTheSecondLengthIsTouchedAndPlaced) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  EXPECT_EQ(source_of(knowledge, {0, 1, 2, 3, 4}), ScaleSource::kTwoLengths);
  EXPECT_EQ(source_of(knowledge, {0, 1, 2, 3}), ScaleSource::kBlock);  // nobody touched the plate
  knowledge.face_uncertainties[4].estimated = true;
  EXPECT_EQ(source_of(knowledge, {0, 1, 2, 3, 4}), ScaleSource::kBlock);  // the plate may lie anywhere
  knowledge.lengths = {{{2, 4}, 0.150, 5e-6}};
  EXPECT_EQ(source_of(knowledge, {0, 1, 2, 3, 4}), ScaleSource::kTwoLengths);  // and now it does not
}

TEST(ScaleSource, IsOneLengthWhereTheOtherIsKnownNoBetterThanADrawing) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.face_uncertainties[4].std_offset_m = 2e-3;
  EXPECT_EQ(source_of(knowledge, {0, 1, 2, 3, 4}), ScaleSource::kBlock);
}

constexpr int kDroopingArms = 4;

/// Of arms that droop by one deviation of two compliances, which are not estimated, with touches of the
/// declared noise: how many are said to contradict their lengths or their artefact. `known`: the deviations
/// are given.
int warnings_of_drooping_arms(bool known) {
  constexpr double kCompliance = 1e-5;
  int warnings = 0;
  for (std::uint64_t seed = 1; seed <= kDroopingArms; ++seed) {
    IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5));
    problem.nominal.masses[3] = {30.0, {0.2, 0.0, 0.1}};
    problem.nominal.masses[6] = {10.0, {0.0, 0.0, 0.1}};
    UniformChance chance(seed);
    drawn::Truth truth = drawn::draw_truth(problem, chance);
    for (const int joint : {1, 2}) {
      truth.arm.compliance_rad_per_nm[static_cast<std::size_t>(joint)] = kCompliance;
      if (known) problem.nongeometric_std[static_cast<std::size_t>(compliance_position(joint))] = kCompliance;
    }
    problem.touches = drawn::touches(truth, {.count = 100}, chance);
    const IdentificationOptions options{.robust = false, .hold_weak = false, .measure_noise = false};
    const IdentificationResult result = identify(problem, options);
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    warnings += result.scale && !result.scale->warning.empty() ? 1 : 0;
  }
  return warnings;
}

// To whoever does not know of it a droop is a wrong length, ball or block.
TEST(ScaleCheck, AComplianceThatWasLeftOutIsNoWrongLength) {
  EXPECT_EQ(warnings_of_drooping_arms(false), kDroopingArms);
  EXPECT_EQ(warnings_of_drooping_arms(true), 0);
}

}  // namespace
}  // namespace calib
