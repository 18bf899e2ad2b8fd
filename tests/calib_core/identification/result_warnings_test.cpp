#include "calib_core/identification/result_warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double kWarnedNoiseMetres = 10e-6;

/// Of touches that were made as `knowledge` says, but for a plane that is displaced outwards.
std::vector<std::string> warnings_of(const ArtefactKnowledge& knowledge, std::size_t displaced_face = 0,
                                     double displaced_m = 0.0) {
  UniformChance chance(4);
  IdentificationProblem problem = drawn::problem(knowledge, kWarnedNoiseMetres);
  drawn::Truth truth = drawn::draw_truth(problem, chance);
  truth.planes[displaced_face].offset_m += displaced_m;
  problem.touches = drawn::touches(truth, {.count = 100, .noise_m = kWarnedNoiseMetres}, chance);
  const IdentificationResult result = identify(problem, {.hold_weak = false});
  EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  return result.warnings;
}

TEST(ResultWarnings, NameATemperatureThatNoWorkshopHas) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  ASSERT_GT(knowledge.std_temperature_k, 0.0);
  ASSERT_GT(knowledge.thermal_expansion_per_k, 0.0);
  const auto warning = HasSubstr("the block was given as 40 degrees C");
  knowledge.warmer_than_20_c_k = 20.0;
  EXPECT_THAT(warnings_of(knowledge), Contains(warning));
  knowledge.warmer_than_20_c_k = 9.0;
  EXPECT_THAT(warnings_of(knowledge), Not(Contains(HasSubstr("degrees C"))));
}

TEST(ResultWarnings, NameAPlaneThatFitsNoOther) {
  const ArtefactKnowledge knowledge = drawn::certain_artefact(5);
  EXPECT_THAT(warnings_of(knowledge), Not(Contains(HasSubstr("were left out"))));
  EXPECT_THAT(warnings_of(knowledge, 3, 2e-3),
              Contains(AllOf(HasSubstr("all 20 touches of plane "), HasSubstr("were left out"),
                             HasSubstr("stylus_radius_mm"))));
}

TEST(ResultWarnings, NameAJointThatWouldGiveWayUpwards) {
  UniformChance chance(4);
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(5), kWarnedNoiseMetres);
  problem.nominal.masses[4] = {20.0, {0.0, 0.0, -0.25}};
  problem.nongeometric_std[static_cast<std::size_t>(compliance_position(1))] = 3e-6;
  drawn::Truth truth = drawn::draw_truth(problem, chance);
  truth.arm.compliance_rad_per_nm[1] = 3e-6;
  problem.touches = drawn::touches(truth, {.count = 100, .noise_m = kWarnedNoiseMetres}, chance);
  const auto warning = HasSubstr("joint 2 would give way upwards");
  EXPECT_THAT(identify(problem, {.stiffness = true}).warnings, Not(Contains(warning)));
  problem.nominal.down_in_frame_1 = -problem.nominal.down_in_frame_1;
  EXPECT_THAT(identify(problem, {.stiffness = true}).warnings,
              Contains(AllOf(warning, HasSubstr("\"down_in_frame_1\""))));
}

TEST(ResultWarnings, NameReferenceTouchesThatHardlyVary) {
  UniformChance chance(4);
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(5), kWarnedNoiseMetres);
  problem.touches =
      drawn::touches(drawn::draw_truth(problem, chance), {.noise_m = kWarnedNoiseMetres}, chance);
  const auto warning = AllOf(HasSubstr("the 8 touches of the reference place scatter by 0.03 um only"),
                             HasSubstr("the declared 10.00 um"), HasSubstr("\"reference_touches\""));
  EXPECT_THAT(identify(problem, {.hold_weak = false}).warnings, Not(Contains(warning)));
  problem.doubted_error = TouchNoise{3e-8, 6.0};
  EXPECT_THAT(identify(problem, {.hold_weak = false}).warnings, Contains(warning));
}

}  // namespace
}  // namespace calib
