#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// Touches that are less certain than the others: each is weighed, tested and propagated by its own noise.
namespace calib {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr double kSureMetres = study::kTouchNoiseMetres;
constexpr double kUnsureMetres = 200e-6;
constexpr int kSure = 68, kUnsure = 32;

const std::vector<int>& unlike_columns() {
  static const std::vector<int> chosen = [] {
    IdentificationProblem problem = drawn::problem(drawn::certain_artefact(4));
    UniformChance chance(1);
    const auto truth = drawn::truth_of(problem, ErrorVector::Zero(), Eigen::VectorXd());
    problem.touches = drawn::touches(truth, {}, chance);
    return identify(problem, {}).identifiable.columns;
  }();
  return chosen;
}

struct UnlikeTouches {
  IdentificationProblem problem;
  drawn::Truth truth;
};

/// A third of the touches has ten times the noise of the others, `share` times what their deviations say.
UnlikeTouches draw_unlike(int seed, const ArtefactKnowledge& knowledge, double share = 1.0) {
  UniformChance chance(static_cast<std::uint64_t>(seed));
  UnlikeTouches made{.problem = drawn::problem(knowledge), .truth = {}};
  made.truth = drawn::truth_of(made.problem, drawn::errors_on(unlike_columns(), chance),
                               Eigen::VectorXd::Zero(std::ssize(made.problem.artefact.parameters)));
  made.problem.touches = drawn::touches(made.truth, {.count = kSure, .noise_m = share * kSureMetres}, chance);
  for (Touch touch :
       drawn::touches(made.truth, {.count = kUnsure, .noise_m = share * kUnsureMetres}, chance)) {
    touch.deviation_m = kUnsureMetres;
    made.problem.touches.push_back(touch);
  }
  return made;
}

IdentificationProblem all_alike(IdentificationProblem problem) {
  for (Touch& touch : problem.touches) touch.deviation_m = 0.0;
  return problem;
}

/// Square of the errors of the identified arm in units of their covariance: the number of errors in the mean.
double standardised_square(const IdentificationResult& result, const ErrorVector& truth) {
  const std::vector<int>& of = result.identifiable.columns;
  const Eigen::VectorXd off = (result.errors.head<kErrorParameterCount>() - truth)(of);
  const Eigen::MatrixXd covariance = result.uncertainty.value().identified(of, of);
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::VectorXd scaled = scale.cwiseProduct(off);
  return scaled.dot(correlation.ldlt().solve(scaled));
}

TEST(TouchDeviation, AnArmIsFarBetterKnownWithItAndByAsMuchAsItsCovarianceSays) {
  constexpr int kSeeds = 40;
  const IdentificationOptions options{.robust = false, .measure_noise = false};
  double with = 0.0, without = 0.0, standardised = 0.0, chi_square = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const UnlikeTouches made = draw_unlike(seed, drawn::certain_artefact(4));
    const IdentificationResult weighed = identify(made.problem, options);
    const IdentificationResult alike = identify(all_alike(made.problem), options);
    ASSERT_EQ(weighed.status, IdentificationStatus::kConverged) << weighed.message;
    ASSERT_EQ(alike.status, IdentificationStatus::kConverged) << alike.message;
    ASSERT_EQ(weighed.identifiable.columns, unlike_columns());
    with += drawn::tip_mean_square_over_touches(weighed.calibrated, made.truth.arm, made.problem.touches) /
            kSeeds;
    without +=
        drawn::tip_mean_square_over_touches(alike.calibrated, made.truth.arm, made.problem.touches) / kSeeds;
    standardised += standardised_square(weighed, made.truth.errors) / kSeeds;
    chi_square += weighed.lack_of_fit.value().statistic / kSeeds;
    EXPECT_GT(weighed.lack_of_fit->p, 1e-4) << seed;
    EXPECT_LT(alike.lack_of_fit.value().p, 1e-6) << seed;
  }
  std::cout << "tip rms " << 1e6 * std::sqrt(with) << " um, all taken alike " << 1e6 * std::sqrt(without)
            << " um; mean standardised square " << standardised / static_cast<double>(unlike_columns().size())
            << "; chi-square over its degrees " << chi_square << "\n";
  EXPECT_LT(std::sqrt(with), 0.4 * std::sqrt(without));
  // Means of 40 chi-squares with 25 and 75 degrees of freedom: four standard deviations.
  EXPECT_NEAR(standardised / static_cast<double>(unlike_columns().size()), 1.0, 0.18);
  EXPECT_NEAR(chi_square, 1.0, 0.11);
}

TEST(TouchDeviation, OfTheDeclaredNoiseChangesNoBit) {
  const UnlikeTouches made = draw_unlike(3, drawn::uncertain_artefact(4));
  const IdentificationProblem none = all_alike(made.problem);
  IdentificationProblem same = none;
  for (Touch& touch : same.touches) touch.deviation_m = same.touch_noise_m;
  for (const Formulation formulation : {Formulation::kSignedDistance, Formulation::kPlaneCoefficients}) {
    const IdentificationOptions options{.formulation = formulation, .robust = false, .measure_noise = false};
    const IdentificationResult a = identify(none, options), b = identify(same, options);
    ASSERT_EQ(a.status, IdentificationStatus::kConverged) << a.message;
    EXPECT_EQ(a.errors, b.errors);
    EXPECT_EQ(a.uncertainty->covariance(), b.uncertainty->covariance());
    EXPECT_EQ(a.lack_of_fit->p, b.lack_of_fit->p);
    EXPECT_EQ(a.singular_values, b.singular_values);
  }
}

TEST(TouchDeviation, OfAllTouchesIsAsGoodAsANoiseDeclaredForThem) {
  UnlikeTouches made = draw_unlike(5, drawn::certain_artefact(4));
  IdentificationProblem declared = all_alike(made.problem);
  for (Touch& touch : made.problem.touches) touch.deviation_m = kUnsureMetres;
  declared.touch_noise_m = kUnsureMetres;
  const IdentificationOptions options{.robust = false, .measure_noise = false};
  const IdentificationResult a = identify(made.problem, options), b = identify(declared, options);
  ASSERT_EQ(a.status, IdentificationStatus::kConverged) << a.message;
  EXPECT_EQ(a.identifiable.columns, b.identifiable.columns);
  EXPECT_LT((a.errors - b.errors).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(a.uncertainty->covariance().trace() / b.uncertainty->covariance().trace(), 1.0, 1e-6);
  EXPECT_NEAR(a.noise_estimated_m.value() / b.noise_estimated_m.value(), kSureMetres / kUnsureMetres, 1e-6);
  EXPECT_NEAR(a.lack_of_fit->p, b.lack_of_fit->p, 1e-6);
}

TEST(TouchDeviation, SaysWhatAnOutlierIs) {
  UnlikeTouches made = draw_unlike(7, drawn::certain_artefact(4));
  UniformChance chance(8);
  made.problem.touches = drawn::touches(made.truth, {}, chance);
  constexpr std::size_t kOff = 41;
  Touch& off = made.problem.touches[kOff];
  const auto lift = [&](double metres) {
    ContactSurface plane = made.truth.planes[static_cast<std::size_t>(off.face)];
    plane.offset_m += metres;
    off = moved_onto_plane(made.truth.arm, plane, off);
  };
  const auto is_off = ElementsAre(Field(&RejectedTouch::touch, kOff));
  lift(0.4e-3);
  EXPECT_THAT(identify(made.problem, {}).rejected, is_off);
  off.deviation_m = kUnsureMetres;
  EXPECT_THAT(identify(made.problem, {}).rejected, IsEmpty());
  lift(1.5e-3);
  EXPECT_THAT(identify(made.problem, {}).rejected, is_off);
}

// All touches are twice as good as they are said to be: those of a deviation of their own as well.
TEST(TouchDeviation, IsMeasuredWithTheNoiseOfTheOthers) {
  UnlikeTouches made = draw_unlike(9, drawn::uncertain_artefact(4), 0.5);
  IdentificationProblem told = made.problem;
  assume_noise(told, 0.5 * kSureMetres);
  EXPECT_DOUBLE_EQ(told.touches.back().deviation_m, 0.5 * kUnsureMetres);
  const IdentificationResult measured = identify(made.problem, {}), known = identify(told, {});
  ASSERT_EQ(measured.status, IdentificationStatus::kConverged) << measured.message;
  ASSERT_EQ(known.status, IdentificationStatus::kConverged) << known.message;
  EXPECT_LT(measured.weight_noise_m, 0.75 * kSureMetres) << "it was weighed anew";
  EXPECT_NEAR(measured.uncertainty->noise_m / known.uncertainty->noise_m, 1.0, 0.05);
  const double apart_m = std::sqrt(
      drawn::tip_mean_square_over_touches(measured.calibrated, known.calibrated, made.problem.touches));
  EXPECT_LT(apart_m, 1e-6);
}

}  // namespace
}  // namespace calib
