// Arms that come as JSON only, and are identified like the TX90.
#include "other_arms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/kinematics/gravity.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "config/arm_file.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"

namespace cell {
namespace {

using testing::HasSubstr;

calib::JointVector joints_in_range(const Arm& arm, std::mt19937_64& chance) {
  std::uniform_real_distribution<double> share(0.1, 0.9);
  calib::JointVector joints;
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    joints[joint] = std::lerp(arm.joint_ranges.lower[joint], arm.joint_ranges.upper[joint], share(chance));
  }
  return joints;
}

calib::Artefact exact(const Cell& cell) {
  return calib::exact_artefact(calib::make_artefact(artefact_knowledge(cell)).contact_planes);
}

/// Postures by chance, each moved until the true tip is on its plane.
std::vector<calib::Touch> exact_touches(const Cell& cell, const calib::KinematicModel& truth,
                                        std::mt19937_64& chance) {
  constexpr double kOnThePlaneMetres = 1e-14;
  constexpr std::size_t kTouchCount = 125;
  const std::vector<calib::ContactSurface> planes = exact(cell).contact_planes;
  std::vector<calib::Touch> touches;
  while (touches.size() < kTouchCount) {
    const std::size_t face = touches.size() % planes.size();
    const calib::Touch start{.face = static_cast<int>(face), .joints = joints_in_range(cell.arm, chance)};
    const calib::Touch touch = calib::moved_onto_plane(truth, planes[face], start);
    const Eigen::Vector3d tip_m = calib::forward_kinematics(truth, touch.joints).translation();
    const bool is_on_plane = std::abs(signed_distance_m(planes[face], tip_m)) < kOnThePlaneMetres;
    if (is_on_plane && cell.arm.joint_ranges.contains(touch.joints)) touches.push_back(touch);
  }
  return touches;
}

class OtherArm : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Arms, OtherArm, testing::Values("tx60", "three-parallel"), [](const auto& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
});

TEST_P(OtherArm, TakesThePlaceOfTheTx90InACell) {
  const Folder folder;
  const Cell cell = demo_with(GetParam(), folder);
  EXPECT_EQ(cell.arm.name, GetParam());
  EXPECT_NO_THROW(demand_revolute(cell));
  const std::string document =
      R"({"schema":"touchcal/touches/1","arm":")" + GetParam() + R"(","touches":[]})";
  EXPECT_NO_THROW(touches_from_json("body", document, document.size(), cell));
}

TEST_P(OtherArm, ShowsTheErrorsThatWerePutInAtItsTip) {
  const Folder folder;
  const Cell cell = demo_with(GetParam(), folder);
  std::mt19937_64 chance(17);
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  calib::ErrorVector errors = calib::ErrorVector::Zero();
  for (const int column : calib::attainable_set(cell.arm.model, exact(cell), {}).columns) {
    const bool is_length = calib::error_parameters()[static_cast<std::size_t>(column)].is_length();
    errors[column] = (is_length ? 1e-3 : 2e-3) * within(chance);
  }
  const calib::KinematicModel truth = calib::apply(cell.arm.model, errors);

  const calib::IdentificationResult result =
      calib::identify({cell.arm.model, exact(cell), exact_touches(cell, truth, chance)}, {});

  ASSERT_EQ(result.status, calib::IdentificationStatus::kConverged) << result.message;
  double nominal_position_error_m = 0.0, calibrated_miss_m = 0.0;
  for (int i = 0; i < 200; ++i) {
    const calib::JointVector joints = joints_in_range(cell.arm, chance);
    const Eigen::Vector3d tip_m = calib::forward_kinematics(truth, joints).translation();
    const auto miss_m = [&](const calib::KinematicModel& model) {
      return (calib::forward_kinematics(model, joints).translation() - tip_m).norm();
    };
    nominal_position_error_m = std::max(nominal_position_error_m, miss_m(cell.arm.model));
    calibrated_miss_m = std::max(calibrated_miss_m, miss_m(result.calibrated));
  }
  EXPECT_GT(nominal_position_error_m, 1e-3);
  EXPECT_LT(calibrated_miss_m, 1e-9);
}

/// Whether two postures differ by whole turns only.
bool is_same_posture(const calib::JointVector& a, const calib::JointVector& b) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return (a - b).unaryExpr([](double angle) { return std::remainder(angle, kTurn); }).norm() < 1e-6;
}

TEST_P(OtherArm, HasEveryPostureOfAPoseAmongThoseThatAreFound) {
  constexpr int kPoseCount = 500;
  constexpr double kRegularDeterminant = 1e-3;
  const Arm arm = read_arm(kSourceDir / "config/arms" / (GetParam() + ".json"));
  const calib::InverseKinematics inverse(arm.model);
  std::mt19937_64 chance(3);
  int tried = 0;
  std::size_t found_count = 0;
  while (tried < kPoseCount) {
    const calib::JointVector joints = joints_in_range(arm, chance);
    const calib::Chain chain = calib::forward_chain(arm.model, joints);
    if (std::abs(calib::pose_jacobian(arm.model, chain).determinant()) < kRegularDeterminant) continue;
    ++tried;
    const calib::Postures found = inverse.solve(chain.block_from_frame.back());
    found_count += found.size();
    EXPECT_TRUE(std::ranges::any_of(found, [&](const auto& other) { return is_same_posture(other, joints); }))
        << joints.transpose();
    for (const calib::JointVector& other : found) {
      const Eigen::Matrix4d miss =
          calib::forward_kinematics(arm.model, other).matrix() - chain.block_from_frame.back().matrix();
      ASSERT_LT(miss.norm(), 2.0 * calib::kPoseErrorMax) << other.transpose();
    }
  }
  // Two shoulders, two elbows and two wrists, but for poses near the end of the reach.
  EXPECT_GT(found_count, std::size_t{6 * kPoseCount});
  EXPECT_LE(found_count, std::size_t{8 * kPoseCount});
}

TEST(SlidingArm, IsReadButNeitherPlannedNorDriven) {
  const Folder folder;
  nlohmann::json arm = json_of(kSourceDir / "config/arms/tx60.json");
  arm["frames"][3]["joint_type"] = "prismatic";
  arm["joint_limits_deg"][2] = {-50, 250};
  arm["joint_max_speeds_deg_s"][2] = 500;
  Cell cell = demo_with("tx60", folder);
  cell.arm = read_arm(folder.write("arm.json", arm.dump()));
  EXPECT_EQ(cell.arm.model.joint_types[2], calib::JointType::kPrismatic);
  EXPECT_DOUBLE_EQ(cell.arm.joint_ranges.lower[2], -0.05);
  EXPECT_DOUBLE_EQ(cell.arm.joint_ranges.upper[2], 0.25);
  EXPECT_DOUBLE_EQ(cell.arm.joint_speeds_max[2], 0.5);
  const ConfigError error = error_of([&] { demand_revolute(cell); });
  EXPECT_EQ(error.pointer(), "/arm");
  EXPECT_THAT(error.what(), HasSubstr("joint 3 of \"tx60\" is prismatic"));

  arm["schema"] = kArmSchema;
  arm["gravity"] = json_of(kSourceDir / "config/arms/tx90.json")["gravity"];
  EXPECT_EQ(error_of([&] { read_arm(folder.write("arm.json", arm.dump())); }).pointer(), "/gravity");
}

// What the shipped arm declares about its stiffness: 0.3 mrad of droop, stretched out, is no surprise.
TEST(Tx90, IsDeclaredStiffEnoughThatATypicalDroopIsOneToTwoDeviations) {
  constexpr double kTypicalDroopRad = 0.3e-3;
  const Arm arm = read_arm(kSourceDir / "config/arms/tx90.json");
  double mass_kg = 0.0;
  for (const calib::PointMass& mass : arm.model.masses) mass_kg += mass.mass_kg;
  EXPECT_LT(mass_kg, 111.0);  // of the whole arm, foot and shoulder included
  calib::JointVector stretched = calib::JointVector::Zero();
  stretched[1] = std::acos(0.0);
  const calib::JointVector torques_nm =
      calib::gravity_torques_nm(arm.model, calib::forward_chain(arm.model, stretched));
  for (const int joint : {1, 2}) {
    const double droop_std_rad =
        arm.nongeometric_std[static_cast<std::size_t>(calib::compliance_position(joint))].value() *
        std::abs(torques_nm[joint]);
    EXPECT_GE(kTypicalDroopRad / droop_std_rad, 1.0);
    EXPECT_LE(kTypicalDroopRad / droop_std_rad, 2.0);
  }
}

}  // namespace
}  // namespace cell
