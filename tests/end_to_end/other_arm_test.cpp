// Whole runs over loopback with other arms than the TX90.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/numerics/halton.hpp"
#include "service/run/run.hpp"
#include "tests/config/other_arms.hpp"
#include "tests/end_to_end/held_out.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::State;

/// The tip's deviation between two models, root mean square over postures in the joint ranges.
double tip_rms_m(const calib::JointRanges& ranges, const calib::KinematicModel& a,
                 const calib::KinematicModel& b) {
  constexpr int kPostureCount = 200;
  double sum = 0.0;
  for (int i = 1; i <= kPostureCount; ++i) {
    const calib::JointVector joints = calib::halton_posture(i, ranges);
    sum += (calib::forward_kinematics(a, joints).translation() -
            calib::forward_kinematics(b, joints).translation())
               .squaredNorm();
  }
  return std::sqrt(sum / kPostureCount);
}

class WholeRunOfAnotherArm : public ::testing::TestWithParam<const char*> {};

TEST_P(WholeRunOfAnotherArm, EndsCompleteWithTheTipCalibrated) {
  const cell::Folder files;
  LoopbackCell loop("demo");
  loop.use(cell::demo_with(GetParam(), files), 2'000);
  const calib::ErrorVector errors = shipped_truth("demo");
  loop.run_whole(kFewCandidates, {.errors = errors});

  ASSERT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  EXPECT_EQ(loop.status().verdict, cell::Verdict::kAccepted);
  const calib::IdentificationResult& result = loop.operation().run()->latest();
  // Of forty fitted touches: kHeldOutMeanMaxMetres and kHeldOutRmsMaxPart are for a hundred.
  EXPECT_LE(held_out(result).mean_max_m, loop.cell.acceptance.held_out_mean_max_m);
  EXPECT_LE(held_out(result).rms_m, loop.cell.acceptance.held_out_rms_max_m);
  const calib::KinematicModel truth = calib::apply(loop.cell.arm.model, errors);
  const double achieved_m = tip_rms_m(loop.cell.arm.joint_ranges, result.calibrated, truth);
  EXPECT_LE(achieved_m, 0.25e-3);
  EXPECT_LE(10.0 * achieved_m, tip_rms_m(loop.cell.arm.joint_ranges, loop.cell.arm.model, truth));
}

INSTANTIATE_TEST_SUITE_P(Arms, WholeRunOfAnotherArm, ::testing::Values("tx60", "three-parallel"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace touchcal::testing
