#include "calib_core/uncertainty/scale_check.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace calib
