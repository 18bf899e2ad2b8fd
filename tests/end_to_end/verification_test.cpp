// Proofs and checks: runs whose touches are held against an earlier calibration.
#include "service/run/verification.hpp"

#include <gmock/gmock.h>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "service/acquisition/touched_block.hpp"
#include "service/documents/block_pose_file.hpp"
#include "service/documents/verification_document.hpp"
#include "service/run/touch_command.hpp"
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
    serve_truth(joint, offset_rad);
  }
  void serve_truth(int joint, double offset_rad) {
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
  /// A reference check of touches of the calibration, from this one on.
  void store_check(std::int64_t calibration, int first) {
    const std::int64_t run = loop_.store().begin_run({.kind = RunKind::kCheck,
                                                      .of_run = calibration,
                                                      .recipe = loop_.store().run(calibration)->recipe,
                                                      .touches_total = calib::kCheckTouchCount,
                                                      .started_at = "2026-11-27T08:00:00.000Z"});
    const auto touches = loop_.store().touches(calibration);
    for (int k = 0; k < calib::kCheckTouchCount; ++k) {
      cell::StoredTouch touch = touches.at(static_cast<std::size_t>(first + k));
      touch.number = k + 1;
      loop_.store().append_touch(run, touch);
    }
    loop_.store().finish_run(run, {.verdict = Verdict::kNone, .ended_at = "2026-11-27T08:02:00.000Z"});
  }
  /// Behind a run that has ended: another plant at the same controller, and the cell made ready again.
  void exchange(const std::function<void()>& serve) {
    loop_.stop_serving();
    loop_.run_until([](const cell::Status& status) { return !status.controller.connected; });
    serve();
    loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
    loop_.command(cell::Command::kReset);
    loop_.run_until(State::kIdle);
  }
  void lift_block(int joint = 1, double offset_rad = 0.0) {
    exchange([&] {
      there_ = cell::with_block_moved(loop_.cell, kLifted);
      serve_truth(joint, offset_rad);
    });
    find_block();
  }
  /// A posture of the true arm with the ball on a face.
  calib::JointVector touching(const cell::PlaceSpot& spot) const {
    const calib::Face& face = there_.block.faces[static_cast<std::size_t>(spot.face)];
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = spot.point_m + plant_.trip_distance_m * face.plane.outward;
    for (const double lean_rad : {0.3, 0.6, 0.9, 1.2}) {
      for (double towards_rad = 0.0; towards_rad < 6.2; towards_rad += 0.5) {
        const Eigen::Vector3d side =
            std::cos(towards_rad) * face.edge_u + std::sin(towards_rad) * face.edge_v();
        pose.linear() =
            calib::shortest_rotation(Eigen::Vector3d::UnitZ(),
                                     std::sin(lean_rad) * side - std::cos(lean_rad) * face.plane.outward)
                .toRotationMatrix();
        for (const auto& near : calib::inverse_kinematics(there_.arm.model, there_.arm.joint_ranges, pose)) {
          if (const auto joints = calib::solve_near(plant_.truth, pose, near)) return *joints;
        }
      }
    }
    throw std::runtime_error("out of reach: " + spot.words);
  }
  /// As the touches of touchcal locate leave it; locating_test follows a person who makes them.
  void find_block() {
    cell::TouchedBlock block{cell::Locating(loop_.cell), std::nullopt};
    for (const cell::PlaceSpot& spot : cell::place_spots(loop_.cell)) {
      const calib::JointVector joints = touching(spot);
      block.take({.wire_joints = cell::to_wire(joints), .joints = joints, .moved_m = 1e-4}, loop_.cell,
                 std::nullopt);
    }
    ASSERT_TRUE(block.found) << block.locating.guide().problem.value_or("");
    cell::BlockPose place = block.found->place;
    place.located_at = "2026-11-27T08:00:00.000Z";
    place.digest = cell::block_pose_digest(loop_.cell);
    cell::write_block_pose(loop_.place_file, place);
    loop_.relaunch();
    loop_.run_until(State::kIdle);
    ASSERT_TRUE(loop_.operation().place());
  }
};

TEST_F(Verification, ACalibratedArmIsProvedOnTheLiftedBlock) {
  const std::int64_t calibration = calibrate();
  EXPECT_THAT(refusal(RunKind::kProof), HasSubstr("proves nothing: lift it by 300 mm"));
  lift_block();
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
  lift_block(3, 1e-3);
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
  exchange([this] { serve_arm(3, 0.3e-3); });
  const cell::StoredRun run = make(RunKind::kCheck);
  const cell::CheckDocument check = check_of(run);
  EXPECT_EQ(run.verdict, Verdict::kRejected);
  EXPECT_EQ(check.cause, "joint");
  EXPECT_EQ(check.joint, 3);
  EXPECT_NEAR(check.joints.at(1).offset_mrad.value(), 0.3, 4.0 * check.joints.at(1).std_offset_mrad.value());
  EXPECT_THAT(check.verdict.reasons, ElementsAre(HasSubstr("joint 3 has changed by 0.3")));
}

/// As two reference checks that disagree were stored once: every later check was held against both.
TEST_F(Verification, ReferenceChecksThatDoNotAgreeBlockNoLaterOne) {
  const std::int64_t calibration = calibrate();
  for (const int first : {0, 20}) store_check(calibration, first);
  for (int count = 1; count <= calib::kReferenceCount; ++count) {
    const cell::StoredRun run = make(RunKind::kCheck);
    EXPECT_EQ(run.verdict, Verdict::kNone);
    EXPECT_EQ(check_of(run).reference.count, count);
    EXPECT_THAT(check_of(run).verdict.reasons,
                ElementsAre(HasSubstr(count == 1 ? "the reference goes on with whichever two agree"
                                                 : "reference check")));
  }
  const cell::StoredRun judged = make(RunKind::kCheck);
  EXPECT_EQ(judged.verdict, Verdict::kAccepted) << ::testing::PrintToString(check_of(judged).verdict.reasons);
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
