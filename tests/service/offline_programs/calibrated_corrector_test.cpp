#include "service/offline_programs/calibrated_corrector.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "calib_core/compensation/arm_sides.hpp"
#include "calib_core/geometry/units.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kWrist = 6;

const Cell& demo() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/demo/cell.json");
  return cell;
}

/// The arm that the demonstration's simulator hides, as if all of it had been identified.
const calib::KinematicModel& truth() {
  static const calib::KinematicModel model =
      true_model(read_truth(kSourceDir / "config/cells/demo/truth-real.json"), demo().arm);
  return model;
}

calib::JointVector joints_deg(const std::array<double, 6>& degrees) {
  calib::JointVector joints;
  for (std::size_t i = 0; i < 6; ++i)
    joints[static_cast<Eigen::Index>(i)] = calib::radians_from_degrees(degrees[i]);
  return joints;
}

CalibratedArm demo_arm() {
  return {.problem = {.nominal = demo().arm.model,
                      .calibrated = truth(),
                      .joint_ranges = demo().arm.joint_ranges},
          .tools = {{"gripper", calib::drawn_tool(demo().tools.at("gripper"))}},
          .reference_joints = joints_deg({0, 30, 60, 0, 60, 0}),
          .reason_of = [](const calib::CompensatedTarget& target) {
            return "reason " + std::to_string(static_cast<int>(target.reason));
          }};
}

/// The gripper of an arm in its controller's world, by the arm's own chain; metres.
Eigen::Isometry3d gripper_of(const calib::KinematicModel& arm, const calib::JointVector& joints) {
  return (calib::frame_transform(arm.links[0]) * calib::frame_transform(arm.links[1])).inverse() *
         calib::forward_chain(arm, joints).block_from_frame[kWrist] * demo().tools.at("gripper");
}

/// theta6 is what no touch sees, and is never applied.
calib::KinematicModel touched_truth() {
  calib::KinematicModel model = truth();
  model.links[kWrist].theta_rad = demo().arm.model.links[kWrist].theta_rad;
  return model;
}

OfflineTarget pose_at(const std::array<double, 6>& degrees, const PostureWords& words = {}) {
  return {"p[0]", OfflinePose{gripper_of(demo().arm.model, joints_deg(degrees)), words}, "gripper"};
}

constexpr std::array<double, 6> kPosture{20, 30, 60, 10, 50, -20};

TEST(CalibratedCorrector, BringsTheTrueArmWhereTheJointsWereMeant) {
  const Corrector corrector = calibrated_corrector(demo_arm());
  const Correction found = corrector({"j[0]", OfflineJoints{kPosture}, "gripper"});
  ASSERT_EQ(found.status, CorrectionStatus::kOk) << found.reason;
  const Eigen::Vector3d meant = gripper_of(demo().arm.model, joints_deg(kPosture)).translation();
  EXPECT_GT((gripper_of(touched_truth(), joints_deg(kPosture)).translation() - meant).norm(), 1e-4);
  EXPECT_LT((gripper_of(touched_truth(), joints_deg(found.joints_deg)).translation() - meant).norm(), 1e-7);
  EXPECT_TRUE(
      found.world_from_tool.isApprox(gripper_of(demo().arm.model, joints_deg(found.joints_deg)), 1e-9));
  EXPECT_NEAR(found.moved_mm,
              1e3 * (gripper_of(touched_truth(), joints_deg(kPosture)).translation() - meant).norm(), 1e-6);
}

TEST(CalibratedCorrector, TakesAPoseInTheConfigurationThatItsWordsAskFor) {
  const Corrector corrector = calibrated_corrector(demo_arm());
  for (const auto& [posture, words] :
       {std::pair{std::array<double, 6>{20, 30, 60, 10, 50, -20},
                  PostureWords{ShoulderWord::kLefty, ElbowWord::kPositive, WristWord::kPositive}},
        std::pair{std::array<double, 6>{20, 30, 60, 10, -50, -20},
                  PostureWords{ShoulderWord::kLefty, ElbowWord::kPositive, WristWord::kNegative}},
        std::pair{std::array<double, 6>{20, 70, -40, 10, 50, -20},
                  PostureWords{ShoulderWord::kLefty, ElbowWord::kNegative, WristWord::kPositive}},
        std::pair{std::array<double, 6>{20, -70, -30, 10, 50, -20},
                  PostureWords{ShoulderWord::kRighty, ElbowWord::kNegative, WristWord::kPositive}}}) {
    const Correction found = corrector(pose_at(posture, words));
    ASSERT_EQ(found.status, CorrectionStatus::kOk) << found.reason;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found.joints_deg[i], posture[i], 3.0) << posture[1];
    const Eigen::Vector3d meant = gripper_of(demo().arm.model, joints_deg(posture)).translation();
    EXPECT_LT((gripper_of(touched_truth(), joints_deg(found.joints_deg)).translation() - meant).norm(), 1e-7);
  }
}

TEST(CalibratedCorrector, TakesAnOpenConfigurationFromTheReferenceAndSaysSo) {
  const Corrector corrector = calibrated_corrector(demo_arm());
  const PostureWords all{ShoulderWord::kLefty, ElbowWord::kPositive, WristWord::kPositive};
  const Correction open = corrector(pose_at(kPosture));
  EXPECT_EQ(open.status, CorrectionStatus::kWarned);
  EXPECT_THAT(open.reason,
              HasSubstr("was taken as lefty, epositive, wpositive; in another one the point would be"));
  EXPECT_TRUE(open.world_from_tool.isApprox(corrector(pose_at(kPosture, all)).world_from_tool, 1e-12));
}

TEST(CalibratedCorrector, RefusesWhatTheCompensationRefuses) {
  const Corrector corrector = calibrated_corrector(demo_arm());
  const Correction wrist = corrector({"j[0]", OfflineJoints{{20, 30, 60, 10, 1, -20}}, "gripper"});
  EXPECT_EQ(wrist.status, CorrectionStatus::kRefused);
  EXPECT_EQ(wrist.reason,
            "reason " + std::to_string(static_cast<int>(calib::CompensationReason::kStraightWrist)));
  OfflineTarget far = pose_at(kPosture);
  std::get<OfflinePose>(far.place).world_from_tool.pretranslate(Eigen::Vector3d(5, 0, 0));
  EXPECT_EQ(corrector(far).reason,
            "reason " + std::to_string(static_cast<int>(calib::CompensationReason::kNominalOutOfReach)));
  EXPECT_THROW(corrector({"j[0]", OfflineJoints{kPosture}, "other"}), std::logic_error);
}

// From the file to the arm: a point two decimals of a degree and a micrometre long is reached within what
// six decimals hold.
TEST(CalibratedCorrector, MakesAFilteredFileThatTheTrueArmReaches) {
  const Eigen::Isometry3d meant = gripper_of(demo().arm.model, joints_deg(kPosture));
  const auto data = [](const std::string& numbers) {
    return new_data(
        variable("fA", "frame", value("key=\"0\" x=\"100\" rz=\"30\" fatherId=\"world[0]\"")) +
        variable("pA", "pointRx",
                 value("key=\"0\"" + numbers +
                       " shoulder=\"lefty\" elbow=\"epositive\" wrist=\"wpositive\" fatherId=\"fA[0]\"")));
  };
  const Eigen::Isometry3d world_from_frame =
      Eigen::Translation3d(0.1, 0, 0) *
      Eigen::AngleAxisd(calib::radians_from_degrees(30), Eigen::Vector3d::UnitZ());
  // The file's numbers by an own product; Rx Ry Rz of the pose in its frame.
  const Eigen::Isometry3d frame_from_tool = world_from_frame.inverse() * meant;
  const Eigen::Vector3d angles = frame_from_tool.linear().eulerAngles(0, 1, 2);
  std::string numbers;
  for (int i = 0; i < 3; ++i)
    numbers +=
        std::string(" ") + "xyz"[i] + "=\"" + stored_number(1e3 * frame_from_tool.translation()[i]) + "\"";
  for (int i = 0; i < 3; ++i)
    numbers +=
        std::string(" r") + "xyz"[i] + "=\"" + stored_number(calib::degrees_from_radians(angles[i])) + "\"";
  const FilteredData once = filtered(data(numbers), "pA offline gripper", calibrated_corrector(demo_arm()));
  ASSERT_EQ(once.count(CorrectionStatus::kOk), 1U) << once.values.at(0).reason;
  EXPECT_NE(once.text, data(numbers));
  // What the controller makes of the new point, and where the true arm is then.
  Eigen::Isometry3d commanded = Eigen::Isometry3d::Identity();
  filtered(once.text, "pA offline gripper", [&](const OfflineTarget& target) {
    commanded = std::get<OfflinePose>(target.place).world_from_tool;
    return Correction{};
  });
  calib::CompensationProblem nominal_only = demo_arm().problem;
  nominal_only.calibrated = nominal_only.nominal;
  const auto joints =
      calib::Compensation(nominal_only)
          .at_pose(calib::drawn_tool(demo().tools.at("gripper")), commanded, joints_deg(kPosture));
  ASSERT_TRUE(joints.joints);
  const Eigen::Isometry3d reached = gripper_of(touched_truth(), *joints.joints);
  EXPECT_LT((reached.translation() - meant.translation()).norm(), 1e-7);
  EXPECT_LT(Eigen::AngleAxisd(reached.linear().transpose() * meant.linear()).angle(), 1e-7);
}

TEST(CalibratedCorrector, DemandsAToolOfEachOfflineVariable) {
  const std::vector<std::string> tools{"gripper", "stylus"};
  const auto refusal = [&](const std::string& list) {
    return std::string(error_of([&] { demand_tools(parse_filter_list("points.list", list), tools); }).what());
  };
  EXPECT_EQ(refusal("pA leave\npB offline\n"),
            "points.list:2: \"pB\" names no tool; write one of gripper, stylus behind offline");
  EXPECT_EQ(
      refusal("pB offline saw\n"),
      "points.list:1: \"pB\" has the tool \"saw\", which is not there; write one of gripper, stylus behind "
      "offline");
  EXPECT_NO_THROW(demand_tools(parse_filter_list("points.list", "pA offline gripper\npB taught\n"), tools));
}

}  // namespace
}  // namespace cell
