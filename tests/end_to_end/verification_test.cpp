// Proofs and checks: runs whose touches are held against an earlier calibration.
#include "service/run/verification.hpp"

#include <gmock/gmock.h>

#include "calib_core/kinematics/error_parameters.hpp"
#include "service/documents/verification_document.hpp"
#include "tests/end_to_end/block_elsewhere.hpp"

namespace touchcal::testing {
namespace {

using cell::RunKind;
using cell::State;
using cell::Verdict;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The cube stands on the ground; y of R_-1 points down.
const Eigen::Isometry3d kLifted(Eigen::Translation3d(0.0, -0.3, 0.0));

class Verification : public BlockElsewhere {
 protected:
  Verification() : BlockElsewhere("demo") { loop_.use(shipped_cell("demo"), 4'000); }

  /// The cell's arm with this offset more at a joint (from 1), at full speed.
  void serve_arm(int joint = 1, double offset_rad = 0.0) {
    there_ = loop_.cell;
    calib::ErrorVector errors = shipped_truth("demo");
    errors[calib::theta_index(joint - 1)] += offset_rad;
    plant_ = sim::make_plant(there_, errors);
    loop_.serve(plant_, {.controller = {.speed = sim::kSpeedMax}, .faults = {}});
  }
  std::int64_t calibrate() {
    serve_arm();
    launch();
    const std::int64_t run = loop_.start(kFewCandidates);
    loop_.run_until_over();
    EXPECT_EQ(loop_.store().run(run)->verdict, Verdict::kAccepted) << loop_.fault_name();
    return run;
  }
  std::int64_t begin(RunKind kind) {
    const auto answer = loop_.ask_to_start({.kind = kind});
    if (const auto* refusal = std::get_if<cell::CommandRefusal>(&answer))
      throw std::runtime_error(refusal->unmet.empty() ? refusal->detail : refusal->unmet.front().detail);
    return std::get<cell::Started>(answer).run.id;
  }
  cell::StoredRun make(RunKind kind) {
    const std::int64_t run = begin(kind);
    loop_.run_until_over();
    EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
    EXPECT_EQ(loop_.fault_name(), "");
    return loop_.store().run(run).value();
  }
  std::string refusal(RunKind kind) {
    try {
      begin(kind);
    } catch (const std::exception& error) {
      return error.what();
    }
    return {};
  }
  cell::CheckDocument check_of(const cell::StoredRun& run) {
    return cell::read_check(loop_.store().result_json(run.id).value());
  }
  void exchange_arm(int joint, double offset_rad) {
    loop_.stop_serving();
    loop_.run_until(State::kResetting);
    serve_arm(joint, offset_rad);
    loop_.run_until(State::kIdle);
  }
};

TEST_F(Verification, ACalibratedArmIsProvedOnTheLiftedBlock) {
  const std::int64_t calibration = calibrate();
  EXPECT_THAT(refusal(RunKind::kProof), HasSubstr("proves nothing: lift it by 300 mm"));
  move_block(kLifted);
  locate_by_hand();
  go_around();
  ASSERT_EQ(loop_.status().state, State::kIdle) << loop_.fault_name();
  EXPECT_THAT(refusal(RunKind::kCheck), HasSubstr("put it back"));

  const cell::StoredRun run = make(RunKind::kProof);
  EXPECT_EQ(run.kind, RunKind::kProof);
  EXPECT_EQ(run.of_run, calibration);
  EXPECT_EQ(run.touches_done, calib::kProofTouchCount);
  const auto proof = cell::read_proof(loop_.store().result_json(run.id).value());
  EXPECT_EQ(run.verdict, Verdict::kAccepted) << ::testing::PrintToString(proof.verdict.reasons);
  EXPECT_EQ(proof.verdict.accepted, true);
  EXPECT_NEAR(proof.moved_mm.value()[1], -300.0, 1.0);
  EXPECT_LT(proof.rms_mm.value(), proof.rms_max_mm.value());
  EXPECT_EQ(proof.touches.size(), static_cast<std::size_t>(calib::kProofTouchCount));
  EXPECT_FALSE(loop_.store().arm_json(run.id)) << "a proof calibrates nothing";
  EXPECT_EQ(loop_.status().last_accepted_run_id, calibration);
  for (const cell::StoredTouch& touch : loop_.store().touches(run.id)) {
    EXPECT_EQ(touch.role, calib::TouchRole::kProof);
    EXPECT_LE(touch.plane, 4) << "the plate is not lifted with the cube";
  }
}

TEST_F(Verification, AnArmThatLostAZeroBehindItsCalibrationIsNotProved) {
  calibrate();
  loop_.stop_serving();
  loop_.run_until(State::kResetting);
  there_ = cell::with_block_moved(loop_.cell, kLifted);
  calib::ErrorVector errors = shipped_truth("demo");
  errors[calib::theta_index(2)] += 1e-3;
  plant_ = sim::make_plant(there_, errors);
  loop_.serve(plant_, {.controller = {.speed = sim::kSpeedMax}, .faults = {}});
  loop_.run_until(State::kIdle);
  locate_by_hand();
  go_around();
  const cell::StoredRun run = make(RunKind::kProof);
  EXPECT_EQ(run.verdict, Verdict::kRejected);
  EXPECT_THAT(cell::read_proof(loop_.store().result_json(run.id).value()).verdict.reasons,
              ::testing::Contains(HasSubstr("the model lacks something, or something has changed")));
}

TEST_F(Verification, TheFirstThreeChecksAreTheReferenceAndALaterOneNamesTheJoint) {
  EXPECT_THAT((serve_arm(), launch(), refusal(RunKind::kCheck)), HasSubstr("no accepted calibration"));
  const std::int64_t calibration = loop_.start(kFewCandidates);
  loop_.run_until_over();
  for (int count = 1; count <= calib::kReferenceCount; ++count) {
    const cell::StoredRun run = make(RunKind::kCheck);
    EXPECT_EQ(run.verdict, Verdict::kNone);
    EXPECT_EQ(check_of(run).reference.count, count);
    EXPECT_EQ(check_of(run).verdict.accepted, std::nullopt);
  }
  const cell::StoredRun quiet = make(RunKind::kCheck);
  EXPECT_EQ(quiet.verdict, Verdict::kAccepted) << ::testing::PrintToString(check_of(quiet).verdict.reasons);
  EXPECT_EQ(quiet.of_run, calibration);
  exchange_arm(3, 0.3e-3);
  const cell::StoredRun run = make(RunKind::kCheck);
  const cell::CheckDocument check = check_of(run);
  EXPECT_EQ(run.verdict, Verdict::kRejected);
  EXPECT_EQ(check.cause, "joint");
  EXPECT_EQ(check.joint, 3);
  EXPECT_NEAR(check.joints.at(1).offset_mrad.value(), 0.3, 4.0 * check.joints.at(1).std_offset_mrad.value());
  EXPECT_THAT(check.verdict.reasons, ElementsAre(HasSubstr("joint 3 has changed by 0.3")));
}

TEST_F(Verification, ACheckIsResumedByTheNextDaemonAndCountsOnce) {
  calibrate();
  const std::int64_t run = begin(RunKind::kCheck);
  loop_.run_until_touches(5);
  loop_.relaunch();
  ASSERT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.operation().run()->kind(), RunKind::kCheck);
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  loop_.command(cell::Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.store().touches(run).size(), static_cast<std::size_t>(calib::kCheckTouchCount));
  EXPECT_EQ(check_of(loop_.store().run(run).value()).reference.count, 1);
}

}  // namespace
}  // namespace touchcal::testing
