#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// Bad input: a status of its own with numbers in its message, and never a number that looks like a result.
namespace calib {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Status = IdentificationStatus;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// 100 touches of Table III's arm on four known faces, faces in turn, all in order.
IdentificationProblem good_problem(int count = 100) {
  IdentificationProblem problem = drawn::problem(drawn::certain_artefact(4));
  UniformChance chance(11);
  const auto truth = drawn::truth_of(problem, paper::table3(), Eigen::VectorXd());
  problem.touches = drawn::touches(truth, {.count = count}, chance);
  return problem;
}

/// The touch as it would be had the face stood farther out.
void lift(const IdentificationProblem& problem, Touch& touch, double metres) {
  const KinematicModel arm = apply(problem.nominal, paper::table3());
  ContactSurface plane = problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)];
  plane.offset_m += metres;
  touch = moved_onto_plane(arm, plane, touch);
}

std::vector<std::size_t> rejected_for(const IdentificationResult& result, RejectionReason reason) {
  std::vector<std::size_t> touches;
  for (const RejectedTouch& rejected : result.rejected) {
    if (rejected.reason == reason) touches.push_back(rejected.touch);
  }
  return touches;
}

struct BadInput {
  std::string name;
  Status status;
  std::string says;
  std::function<void(IdentificationProblem&, IdentificationOptions&)> spoil;
};

void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

class Refusals : public ::testing::TestWithParam<BadInput> {};

TEST_P(Refusals, HaveAStatusNumbersAndNoResult) {
  IdentificationProblem problem = good_problem();
  IdentificationOptions options;
  ASSERT_EQ(identify(problem, options).status, Status::kConverged);
  GetParam().spoil(problem, options);
  const auto result = identify(problem, options);
  EXPECT_EQ(result.status, GetParam().status);
  EXPECT_THAT(result.message, AllOf(HasSubstr(GetParam().says), ContainsRegex("[0-9]")));
  EXPECT_FALSE(result.uncertainty || result.scale || result.lack_of_fit || result.noise_estimated_m);
  EXPECT_EQ(result.errors.norm(), 0.0);
  EXPECT_EQ(result.artefact_errors.size(), 0);
}

void keep_faces(IdentificationProblem& problem, const std::function<bool(const Touch&)>& kept) {
  std::erase_if(problem.touches, [&](const Touch& touch) { return !kept(touch); });
}

const std::vector<BadInput>& bad_inputs() {
  using Problem = IdentificationProblem;
  using Options = IdentificationOptions;
  static const std::vector<BadInput> all{
      {"FewerTouchesThanUnknowns", Status::kTooFewTouches,
       "24 touches, but 25 parameters need at least 25: 1 more are missing (1 on plane 1)",
       [](Problem& problem, Options&) { problem.touches.resize(24); }},
      {"NoTouches", Status::kTooFewTouches, "0 touches, but 25 parameters",
       [](Problem& problem, Options&) { problem.touches.clear(); }},
      {"NoTouchesWithPrior", Status::kTooFewTouches, "0 touches",
       [](Problem& problem, Options& options) {
         problem.touches.clear();
         options.prior = true;
       }},
      {"OnlyHeldOutTouches", Status::kTooFewTouches, "0 touches",
       [](Problem& problem, Options&) {
         for (Touch& touch : problem.touches) touch.role = TouchRole::kHeldOut;
       }},
      {"AllOnOnePlane", Status::kOneFace, "all 60 touches are on plane 3",
       [](Problem& problem, Options&) {
         problem = good_problem(240);
         keep_faces(problem, [](const Touch& touch) { return touch.face == 2; });
       }},
      {"OnePostureRepeated", Status::kOnePosture, "all 40 touches are one posture",
       [](Problem& problem, Options&) { problem.touches.assign(40, problem.touches.front()); }},
      {"OnePostureRepeatedTo5Microradians", Status::kOnePosture, "all 100 touches are one posture",
       [](Problem& problem, Options&) {
         for (std::size_t i = 0; i < problem.touches.size(); ++i) {
           problem.touches[i] = problem.touches[0];
           problem.touches[i].joints[static_cast<Eigen::Index>(i) % 6] += 5e-6;
         }
       }},
      {"APlaneLeftOut", Status::kUnobservable, "no touch on plane 4",
       [](Problem& problem, Options&) {
         keep_faces(problem, [](const Touch& touch) { return touch.face != 3; });
       }},
      {"ATouch60MillimetresOffItsPlane", Status::kFarTouch, "touch 3 is 6",
       [](Problem& problem, Options&) {
         lift(problem, problem.touches[2], 0.060);
         // In the middle of the face, so that it is near no other plane either.
         const double other = std::abs(
             signed_distance_m(problem.artefact.contact_planes[3],
                               forward_kinematics(problem.nominal, problem.touches[2].joints).translation()));
         ASSERT_GT(other, kOnOtherPlaneMetres);
       }},
      {"AHeldOutTouchFarOff", Status::kFarTouch, "touch 3 is 6",
       [](Problem& problem, Options&) {
         lift(problem, problem.touches[2], 0.060);
         problem.touches[2].role = TouchRole::kHeldOut;
       }},
      {"AWrongPlaneWhenNothingMayBeLeftOut", Status::kFarTouch, "touch 1 is 1",
       [](Problem& problem, Options& options) {
         problem.touches[0].face = 3;
         options.robust = false;
       }},
      {"AJointThatIsNoNumber", Status::kBadInput, "touch 5 has a joint",
       [](Problem& problem, Options&) { problem.touches[4].joints[2] = kNaN; }},
      {"ADeviationBelowZero", Status::kBadInput,
       "the standard deviation of touch 6 is -0.02 mm; give one of 1 nm",
       [](Problem& problem, Options&) { problem.touches[5].deviation_m = -20e-6; }},
      {"ADeviationThatIsNoNumber", Status::kBadInput, "the standard deviation of touch 6 is nan mm",
       [](Problem& problem, Options&) { problem.touches[5].deviation_m = kNaN; }},
      {"ADeviationThatIsNoTouch", Status::kBadInput,
       "touch 6 is 5.1 mm; give one of 1 nm or more and up to 5.0 mm",
       [](Problem& problem, Options&) { problem.touches[5].deviation_m = 5.1e-3; }},
      {"ADeviationSmallerThanAnyRounding", Status::kBadInput, "the standard deviation of touch 6 is 1e-11 mm",
       [](Problem& problem, Options&) { problem.touches[5].deviation_m = 1e-14; }},
      {"ADeviationBesideAnUnknownNoise", Status::kBadInput, "touch 6 has a standard deviation of its own",
       [](Problem& problem, Options&) {
         problem.touches[5].deviation_m = 50e-6;
         problem.touch_noise_m = 0.0;
       }},
      {"APlaneThatDoesNotExist", Status::kBadInput, "touch 8 is on plane 5, but there are 4 planes",
       [](Problem& problem, Options&) { problem.touches[7].face = 4; }},
      {"APlaneBeforeTheFirst", Status::kBadInput, "touch 8 is on plane 0",
       [](Problem& problem, Options&) { problem.touches[7].face = -1; }},
      {"APlaneOfNoNumbers", Status::kBadInput, "plane 2",
       [](Problem& problem, Options&) { problem.artefact.contact_planes[1].offset_m = kNaN; }},
      {"AnArmOfNoNumbers", Status::kBadInput, "d3",
       [](Problem& problem, Options&) { problem.nominal.links[3].d_m = kNaN; }},
      {"CoincidingPlanes", Status::kCoincidingPlanes, "plane 1 and plane 5 coincide (0.0 mm apart)",
       [](Problem& problem, Options&) {
         problem.artefact.contact_planes.push_back(problem.artefact.contact_planes[0]);
       }},
      {"EquationSixThroughTheOrigin", Status::kBadInput, "plane 3 goes through the origin",
       [](Problem& problem, Options& options) {
         problem.artefact.contact_planes[2].offset_m = 0.0;
         options.formulation = Formulation::kPlaneCoefficients;
       }},
      {"AToleranceOfNothing", Status::kSingularPrior, "d3 is 0",
       [](Problem& problem, Options& options) {
         problem.tolerances[static_cast<std::size_t>(error_parameter_index("d3").value())] = 0.0;
         options.prior = true;
       }},
      {"AComplianceKnownWithNoTolerance", Status::kSingularPrior, "compliance3 is 0",
       [](Problem& problem, Options& options) {
         problem.nongeometric_std[static_cast<std::size_t>(compliance_position(1))] = 1e-6;
         problem.nongeometric_std[static_cast<std::size_t>(compliance_position(2))] = 0.0;
         options.stiffness = true;
       }},
      {"AComplianceThatNobodyDeclared", Status::kBadInput, "std_compliance_rad_per_nm",
       [](Problem&, Options& options) { options.stiffness = true; }},  // an arm without masses
      {"ALengthWithoutTolerance", Status::kSingularPrior, "length 1 is 0",
       [](Problem& problem, Options&) {
         problem.artefact = make_artefact(drawn::uncertain_artefact(4));
         problem.artefact.equations = {{{{0, 1.0}}, 0.0, 0.0}};
       }},
      {"TooFewIterations", Status::kNotConverged, "no convergence in 1 iterations (residual rms ",
       [](Problem&, Options& options) { options.iterations_max = 1; }},
  };
  return all;
}

INSTANTIATE_TEST_SUITE_P(BadInputs, Refusals, ::testing::ValuesIn(bad_inputs()),
                         [](const auto& info) { return info.param.name; });

TEST(BadNoise, IsRefusedInsteadOfWeighed) {
  for (const double noise : {kNaN, -20e-6, std::numeric_limits<double>::infinity()}) {
    IdentificationProblem problem = good_problem();
    problem.touch_noise_m = noise;
    EXPECT_EQ(identify(problem, {}).status, Status::kBadInput) << noise;
  }
  // A prior weighs against the noise; without one it may be unknown.
  IdentificationProblem problem = good_problem();
  problem.touch_noise_m = 0.0;
  EXPECT_EQ(identify(problem, {}).status, Status::kConverged);
  IdentificationOptions options;
  options.prior = true;
  const auto result = identify(problem, options);
  EXPECT_EQ(result.status, Status::kBadInput);
  EXPECT_THAT(result.message, HasSubstr("touch_noise_mm"));
}

TEST(ProofTouches, MayBeAnywhere) {
  IdentificationProblem problem = good_problem();
  problem.touches.push_back(problem.touches[2]);
  problem.touches.back().role = TouchRole::kProof;
  lift(problem, problem.touches.back(), 0.300);
  EXPECT_EQ(identify(problem, {}).status, Status::kConverged);
}

TEST(WrongPlane, IsNamedAndLeftOut) {
  IdentificationProblem problem = good_problem();
  const auto without = identify(problem, {});
  problem.touches[40].face = 3;                    // was made on plane 1, 150 mm away
  problem.touches[41].face = 2;                    // was made on plane 2
  problem.touches[77].face = 0;                    // was made on plane 2
  problem.touches[77].role = TouchRole::kHeldOut;  // would spoil the validation
  const auto result = identify(problem, {});
  ASSERT_EQ(result.status, Status::kConverged) << result.message;
  std::vector<std::size_t> named = rejected_for(result, RejectionReason::kWrongFace);
  for (const std::size_t outlier : rejected_for(result, RejectionReason::kOutlier)) named.push_back(outlier);
  std::ranges::sort(named);
  EXPECT_EQ(named, (std::vector<std::size_t>{40, 41, 77}));
  EXPECT_EQ(result.rejected.front().reason, RejectionReason::kWrongFace);
  EXPECT_EQ(result.rejected.front().touch, 40u);
  EXPECT_NEAR(std::abs(result.rejected.front().residual_m), 0.150, 0.013);  // a ball on either side
  EXPECT_EQ(result.fitted_touch_count, 97);
  const double apart =
      std::sqrt(drawn::tip_mean_square_over_touches(result.calibrated, without.calibrated, problem.touches));
  EXPECT_LT(apart, 2.0 * study::kTouchNoiseMetres);
}

TEST(ContradictoryTouches, GiveNoResult) {
  // Every touch somewhere within 8 mm of its face: there is no arm that half of them agree on.
  for (const bool robust : {true, false}) {
    IdentificationProblem problem = good_problem();
    UniformChance chance(12);
    for (Touch& touch : problem.touches) lift(problem, touch, 0.008 * (2.0 * chance() - 1.0));
    IdentificationOptions options;
    options.robust = robust;
    const auto result = identify(problem, options);
    if (!robust) {  // all are believed, and the misfit is told
      ASSERT_EQ(result.status, Status::kConverged) << result.message;
      EXPECT_LT(result.lack_of_fit->p, 1e-9);
      continue;
    }
    EXPECT_EQ(result.status, Status::kContradictory);
    EXPECT_THAT(result.message, AllOf(HasSubstr("100 touches"), ContainsRegex("residual rms [0-9]")));
    EXPECT_FALSE(result.uncertainty || result.scale || result.lack_of_fit);
    EXPECT_EQ(result.errors.norm(), 0.0);
  }
}

TEST(NonConvergence, GivesItsHistory) {
  IdentificationProblem problem = good_problem();
  IdentificationOptions options;
  options.iterations_max = 2;
  const auto result = identify(problem, options);
  ASSERT_EQ(result.status, Status::kNotConverged);
  ASSERT_EQ(result.iterations.size(), 2u);
  EXPECT_GT(result.iterations[0].residual_rms_m, result.iterations[1].residual_rms_m);
  EXPECT_GT(result.iterations[0].step_norm, kStepNormConverged);
  EXPECT_THAT(result.message, ContainsRegex("residual rms [0-9.]+ mm step [0-9.]+.*, [0-9.]+ mm step"));
}

TEST(TenThousandTouches, AreIdentifiedFromAndTheBadOnesNamed) {
  constexpr std::size_t kBad = 500;
  IdentificationProblem problem = good_problem(10'000);
  const auto clean = identify(problem, {});
  ASSERT_EQ(clean.status, Status::kConverged) << clean.message;
  EXPECT_TRUE(clean.rejected.empty());
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < kBad; ++i) {
    bad.push_back(20 * i);
    lift(problem, problem.touches[bad.back()], 1e-3);
  }
  const auto result = identify(problem, {});
  ASSERT_EQ(result.status, Status::kConverged) << result.message;
  EXPECT_EQ(rejected_for(result, RejectionReason::kOutlier), bad);
  EXPECT_LT(
      std::sqrt(drawn::tip_mean_square_over_touches(result.calibrated, clean.calibrated, problem.touches)),
      study::kTouchNoiseMetres);
}

TEST(TheResult, DoesNotDependOnTheOrderOfTouches) {
  for (const bool prior : {false, true}) {
    IdentificationProblem problem = drawn::problem(drawn::uncertain_artefact(5));
    UniformChance chance(13);
    const auto truth =
        drawn::truth_of(problem, paper::table3(), drawn::draw_artefact_errors(problem.artefact, chance));
    problem.touches = drawn::touches(truth, {.count = 80}, chance);
    lift(problem, problem.touches[33], 2e-3);
    IdentificationOptions options;
    options.prior = prior;
    const auto forward = identify(problem, options);
    ASSERT_EQ(forward.status, Status::kConverged) << forward.message;
    ASSERT_EQ(forward.rejected.size(), 1u);
    for (int shuffle = 0; shuffle < 5; ++shuffle) {
      IdentificationProblem other = problem;
      std::vector<std::size_t> from(problem.touches.size());
      std::iota(from.begin(), from.end(), 0u);
      for (std::size_t i = from.size(); i > 1; --i) {
        std::swap(from[i - 1], from[static_cast<std::size_t>(chance() * static_cast<double>(i))]);
      }
      for (std::size_t i = 0; i < from.size(); ++i) other.touches[i] = problem.touches[from[i]];
      const auto shuffled = identify(other, options);
      ASSERT_EQ(shuffled.status, Status::kConverged) << shuffled.message;
      EXPECT_LT((shuffled.errors - forward.errors).norm(), 1e-9);
      EXPECT_LT((shuffled.artefact_errors - forward.artefact_errors).norm(), 1e-9);
      ASSERT_EQ(shuffled.rejected.size(), 1u);
      EXPECT_EQ(from[shuffled.rejected[0].touch], 33u);
    }
  }
}

TEST(TheResult, IsTheSameToTheBitWhenRepeated) {
  IdentificationProblem problem = good_problem();
  lift(problem, problem.touches[33], 2e-3);
  const auto first = identify(problem, {});
  const auto second = identify(problem, {});
  ASSERT_EQ(first.status, Status::kConverged) << first.message;
  EXPECT_EQ(first.errors, second.errors);
  EXPECT_EQ(first.uncertainty->covariance(), second.uncertainty->covariance());
  EXPECT_EQ(first.rejected.size(), 1u);
  EXPECT_EQ(rejected_for(first, RejectionReason::kOutlier), rejected_for(second, RejectionReason::kOutlier));
}

}  // namespace
}  // namespace calib
