// The validations of the paper's section V.B: B.1 the same touches, B.2 others, B.3 and B.4 distances.
#include "calib_core/identification/validate.hpp"

#include <gtest/gtest.h>

#include "tests/calib_core/block_study.hpp"

namespace calib {
namespace {

constexpr int kFitPerFace = 12;
constexpr int kOtherPerFace = 10;

class ValidateTest : public ::testing::Test {
 protected:
  ValidateTest() {
    UniformChance chance(1);
    const KinematicModel truth = apply(paper::nominal(), study::draw_errors(chance));
    fitted_ = study::exact_touches(truth, kFitPerFace, chance);
    problem_.touches = study::with_noise(fitted_, study::kTouchNoiseMetres, chance);
    others_ = study::with_noise(study::exact_touches(truth, kOtherPerFace, chance), study::kTouchNoiseMetres,
                                chance);
    options_.identifiability.tried_last = paper::tried_last();
  }

  void hold_out(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      problem_.touches.push_back(others_[i]);
      problem_.touches.back().role = TouchRole::kHeldOut;
    }
  }

  IdentificationProblem problem_{.nominal = paper::nominal(),
                                 .artefact = exact_artefact(paper::planes()),
                                 .touch_noise_m = study::kTouchNoiseMetres};
  IdentificationOptions options_;
  std::vector<study::ExactTouch> fitted_;
  std::vector<Touch> others_;
};

TEST_F(ValidateTest, TheSameTouchesGiveNoNewErrors) {
  const Validation validation = validate(problem_, options_);
  ASSERT_TRUE(validation.same_touches.done()) << validation.same_touches.message;
  EXPECT_EQ(validation.same_touches.touch_count, 4 * kFitPerFace);
  EXPECT_LT(validation.same_touches.new_error_max(), kSameTouchesErrorMax);
  EXPECT_TRUE(validation.passed());
  EXPECT_GT(validation.result.errors.norm(), 1e3 * kSameTouchesErrorMax) << "nothing was identified at all";
}

TEST_F(ValidateTest, TheSameHoldsWithAPriorAndWithArtefactParameters) {
  problem_.tolerances.fill(0.01);
  ArtefactParameter radius{.name = "stylus_radius", .kind = ArtefactKind::kStylusRadius, .std = 5e-6};
  for (std::size_t face = 0; face < paper::planes().size(); ++face)
    radius.shifts.push_back({.constant = -1.0, .per_metre = Eigen::Vector3d::Zero()});
  problem_.artefact.parameters = {radius};
  for (const bool prior : {false, true}) {
    options_.prior = prior;
    const Validation validation = validate(problem_, options_);
    ASSERT_TRUE(validation.same_touches.done()) << validation.same_touches.message;
    EXPECT_LT(validation.same_touches.new_error_max(), kSameTouchesErrorMax) << prior;
  }
}

TEST_F(ValidateTest, ARejectedTouchIsLeftOutTheSecondTimeToo) {
  problem_.touches[5].joints += 1e-3 * fitted_[5].joints_per_metre;
  const Validation validation = validate(problem_, options_);
  ASSERT_EQ(validation.result.rejected.size(), 1U);
  EXPECT_EQ(validation.same_touches.touch_count, 4 * kFitPerFace - 1);
  EXPECT_TRUE(validation.passed()) << validation.same_touches.new_error_max();
}

TEST_F(ValidateTest, OtherTouchesGiveNewErrorsOfTheSizeThatIsPredicted) {
  const Validation validation = validate(problem_, options_, others_);
  const Repetition& other = validation.other_touches;
  ASSERT_TRUE(other.done()) << other.message;
  EXPECT_EQ(other.touch_count, 4 * kOtherPerFace);
  EXPECT_GT(other.new_error_max(), kSameTouchesErrorMax);
  for (const int column : validation.result.identifiable.columns) {
    EXPECT_GT(other.std_new_errors[column], 0.0);
    EXPECT_LT(std::abs(other.new_errors[column]), 5.0 * other.std_new_errors[column])
        << error_parameters()[static_cast<std::size_t>(column)].name();
  }
}

TEST_F(ValidateTest, OtherTouchesCountAsHeldOutInTheDistances) {
  const Validation validation = validate(problem_, options_, others_);
  int fitted = 0, held_out = 0;
  for (const FaceDistances& face : validation.result.distances) {
    (face.role == TouchRole::kFit ? fitted : held_out) += face.touch_count;
    EXPECT_LT(face.calibrated_rms_m, 3.0 * study::kTouchNoiseMetres);
    EXPECT_GT(face.nominal_rms_m, face.calibrated_rms_m);
  }
  EXPECT_EQ(fitted, 4 * kFitPerFace);
  EXPECT_EQ(held_out, 4 * kOtherPerFace);
}

TEST_F(ValidateTest, HeldOutTouchesAreTheOtherSetWhenThereAreEnough) {
  const auto needed = static_cast<std::size_t>(validate(problem_, options_).result.attainable.count) +
                      static_cast<std::size_t>(kSpareTouchesMin);
  ASSERT_GE(others_.size(), needed);
  hold_out(needed - 1);
  const Validation few = validate(problem_, options_);
  EXPECT_FALSE(few.other_touches.done());
  EXPECT_NE(few.other_touches.message.find(std::to_string(needed)), std::string::npos)
      << few.other_touches.message;
  EXPECT_TRUE(few.passed()) << "B.1 does not need them";
  problem_.touches.push_back(others_[needed - 1]);
  problem_.touches.back().role = TouchRole::kHeldOut;
  EXPECT_TRUE(validate(problem_, options_).other_touches.done());
}

TEST_F(ValidateTest, WhatIsNotIdentifiedIsNotValidated) {
  problem_.touches.resize(3);
  const Validation validation = validate(problem_, options_, others_);
  EXPECT_EQ(validation.result.status, IdentificationStatus::kTooFewTouches);
  EXPECT_FALSE(validation.passed());
  EXPECT_FALSE(validation.other_touches.done());
}

}  // namespace
}  // namespace calib
