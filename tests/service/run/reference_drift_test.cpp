#include "service/run/reference_drift.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "config/identification_problem.hpp"
#include "config/read_config.hpp"
#include "service/run/run_repeats.hpp"

namespace cell {
namespace {

TEST(ReferenceDrift, IsTheLineThroughTheReadings) {
  EXPECT_NEAR(reference_place({0.0, 1e-5, 2e-5, 3e-5}).trend_m, 3e-5, 1e-15);
  EXPECT_NEAR(reference_place({0.0, -1e-5, -2e-5}).trend_m, 2e-5, 1e-15);
}

TEST(ReferenceDrift, IsNothingOfTooFewReadings) {
  EXPECT_EQ(reference_place({}).trend_m, 0.0);
  EXPECT_EQ(reference_place({0.0, 1e-4}).trend_m, 0.0) << "two readings cannot tell drift from noise";
}

// Readings 1, 2, 2, 5: the slope of 1.2 has a variance of 0.18 with two degrees of freedom (R's lm()).
TEST(ReferenceDrift, BelowSignificanceLeavesOpenWhatTheScatterHides) {
  const ReferencePlace place = reference_place({1.0, 2.0, 2.0, 5.0});
  EXPECT_EQ(place.trend_m, 0.0);
  EXPECT_NEAR(place.open_trend.std_m, 3.0 * std::sqrt(0.18), 1e-12);
  EXPECT_EQ(place.open_trend.degrees_of_freedom, 2.0);
  EXPECT_EQ(reference_place({0.0, 1e-4}).open_trend.std_m, 0.0);
}

TEST(ReferenceDrift, RunsOverTheTimesOfTheReadings) {
  const std::vector<double> warming{0.0, 1e-5, 2e-5, 1e-4};
  EXPECT_NEAR(reference_place(warming, std::vector{0.0, 60.0, 120.0, 600.0}).trend_m, 1e-4, 1e-15);
  EXPECT_EQ(reference_place(warming).trend_m, 0.0) << "over their order it is a bend";
}

/// Mean square of the trend over many runs with this drift and noise.
double mean_square(double drift_m, double noise_m) {
  calib::UniformChance chance(11);
  constexpr int kReadings = 16, kRuns = 400;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> readings_m;
    for (int i = 0; i < kReadings; ++i)
      readings_m.push_back(drift_m * i / (kReadings - 1) + noise_m * std::sqrt(12.0) * (chance() - 0.5));
    for (std::size_t i = readings_m.size(); i-- > 0;) readings_m[i] -= readings_m[0];
    sum += std::pow(reference_place(readings_m).trend_m, 2);
  }
  return sum / kRuns;
}

TEST(ReferenceDrift, DoesNotTakeTheNoiseOfTheReadingsForDrift) {
  constexpr double kNoiseM = 20e-6;
  EXPECT_LT(std::sqrt(mean_square(0.0, kNoiseM)), 0.2 * kNoiseM) << "its line alone would have 0.8";
  EXPECT_NEAR(std::sqrt(mean_square(100e-6, kNoiseM)), 100e-6, 5e-6);
}

/// The cell `demo` with an arm of whose stops the maker says this; nothing: 0.
Cell cell_with_stops(double std_rad = 0.0) {
  Cell cell = read_cell(TOUCHCAL_SOURCE_DIR "/config/cells/demo/cell.json");
  cell.arm.gears.repeatability_rad.setConstant(std_rad);
  return cell;
}

/// Ten touches of one place on plane 3 that scatter by this along its normal, noted as touches of `face`.
calib::IdentificationProblem noted(double noise_m, int face, const Cell& cell = cell_with_stops()) {
  calib::IdentificationProblem problem = identification_problem(cell, cell.recipes.at("quick"));
  constexpr int kTouched = 2;
  const calib::ContactSurface& plane = problem.artefact.contact_planes[kTouched];
  calib::Touch touch =
      calib::moved_onto_plane(problem.nominal, plane, {.face = kTouched, .joints = cell.park_joints});
  Eigen::Matrix<double, 6, 1> away = Eigen::Matrix<double, 6, 1>::Zero();
  away.head<3>() = plane.outward;
  const calib::JointVector per_metre =
      calib::pose_jacobian(problem.nominal, forward_chain(problem.nominal, touch.joints))
          .partialPivLu()
          .solve(away);
  calib::UniformChance chance(3);
  std::vector<calib::Touch> touches(10, touch);
  for (calib::Touch& made : touches) {
    made.face = face;
    made.joints += noise_m * std::sqrt(12.0) * (chance() - 0.5) * per_metre;
  }
  note_repeats({.references = touches, .reference_times_s = {}, .two_speed = {}, .touched_again = {}},
               problem);
  return problem;
}

TEST(References, TellTheNoiseOfATouch) {
  const calib::IdentificationProblem problem = noted(8e-6, 2);
  EXPECT_FALSE(problem.doubted_error);
  ASSERT_TRUE(problem.pure_error);
  EXPECT_NEAR(problem.pure_error->std_m, 8e-6, 3e-6);
}

// Readings of a plane that was not touched do not follow the contact: hardly any of the scatter is left.
TEST(References, OfAnotherPlaneAreNotBelieved) {
  const calib::IdentificationProblem problem = noted(8e-6, 0);
  EXPECT_FALSE(problem.pure_error) << "the declared noise stays what is known";
  ASSERT_TRUE(problem.doubted_error);
  EXPECT_LT(problem.doubted_error->std_m, calib::kProbeScatterMinMetres);
  EXPECT_EQ(problem.drift_m, 0.0);
}

// An arm whose maker lets it stop within 30 um does not repeat to a quarter of a micrometre.
TEST(References, ThatScatterFarLessThanTheStopsOfTheArmAreNotBelieved) {
  const Cell cell = cell_with_stops(30e-6);
  EXPECT_FALSE(noted(5e-7, 2).doubted_error);
  EXPECT_TRUE(noted(5e-7, 2, cell).doubted_error);
  EXPECT_FALSE(noted(10e-6, 2, cell).doubted_error);
}

}  // namespace
}  // namespace cell
