#include "config/arm_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "calib_core/geometry/units.hpp"
#include "config/arm_file.hpp"
#include "folder.hpp"

namespace cell {
namespace {

/// A length goes through its millimetres: half a bit there and half a bit back, in numbers below 2 m.
constexpr double kLengthLostMaxMetres = 2.3e-16;

Arm shipped_arm(const std::string& name) { return read_arm(kSourceDir / "config/arms" / (name + ".json")); }

/// Figures that fit no short decimal number, as a calibration gives them.
Arm calibrated(Arm arm) {
  std::mt19937_64 chance(11);
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  calib::ErrorVector errors;
  for (Eigen::Index i = 0; i < errors.size(); ++i) errors[i] = 0.003 * within(chance);
  arm.model = calib::apply(arm.model, errors);
  for (std::optional<double>& std : arm.std_errors) {
    if (std) *std *= 1.0 + 0.1 * within(chance);
  }
  arm.name += " \"calibrated\" é";
  return arm;
}

Arm sliding() {
  Arm arm = calibrated(shipped_arm("tx90"));
  arm.model.joint_types[2] = calib::JointType::kPrismatic;
  arm.model.joint_types[4] = calib::JointType::kPrismatic;
  arm.model.gains[2] = -0.5;
  arm.model.masses = {};
  arm.nongeometric_std = {};
  for (const int joint : {2, 4}) {
    arm.joint_ranges.lower[joint] = -0.1237;
    arm.joint_ranges.upper[joint] = 1.0 / 3.0;
    arm.joint_speeds_max[joint] = 0.7;
  }
  return arm;
}

Arm bending() {
  Arm arm = calibrated(shipped_arm("tx90"));
  arm.model.down_in_frame_1 = Eigen::Vector3d::UnitX();  // on a wall
  arm.model.harmonics_rad[3] = {1e-5, -2e-5};
  for (const int joint : {2, 4}) {
    arm.model.ripple_periods_per_turn[static_cast<std::size_t>(joint)] = joint == 2 ? 96.0 : 59.75;
    arm.model.ripples_rad[static_cast<std::size_t>(joint)] = {1.25e-5, -3e-6};
    for (int position = calib::ripple_position(joint); position <= calib::ripple_position(joint) + 1;
         ++position)
      arm.nongeometric_std[static_cast<std::size_t>(position)] = arm.gears.ripple_rad[joint] / std::sqrt(2.0);
  }
  arm.model.compliance_rad_per_nm[1] = 1.234567890123e-6;
  arm.model.compliance_rad_per_nm[2] = -1e-8;
  arm.model.compliance_rad_per_nm[4] = 2.5e-4;  // touches that hardly show it
  return arm;
}

Arm without_bodies() {
  Arm arm = shipped_arm("tx60");
  arm.bodies.clear();
  return arm;
}

struct Case {
  std::string name;
  Arm arm;
};

class EveryArm : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] static Arm read_back(const Arm& arm) {
    const Folder folder;
    return read_arm(folder.write("arm.json", arm_document(arm)));
  }
};
INSTANTIATE_TEST_SUITE_P(Arms, EveryArm,
                         testing::Values(Case{"Tx90", shipped_arm("tx90")}, Case{"Tx60", shipped_arm("tx60")},
                                         Case{"ThreeParallel", shipped_arm("three-parallel")},
                                         Case{"Calibrated", calibrated(shipped_arm("tx90"))},
                                         Case{"Sliding", sliding()}, Case{"Bending", bending()},
                                         Case{"WithoutBodies", without_bodies()}),
                         [](const auto& info) { return info.param.name; });

void expect_near(const Eigen::Vector3d& point_m, const Eigen::Vector3d& expected_m) {
  EXPECT_LE((point_m - expected_m).cwiseAbs().maxCoeff(), kLengthLostMaxMetres);
}

TEST_P(EveryArm, IsReadBackWithTheSameKinematics) {
  const Arm& arm = GetParam().arm;
  const Arm back = read_back(arm);
  for (std::size_t frame = 0; frame < calib::kFrameCount; ++frame) {
    const calib::LinkParameters& link = arm.model.links[frame];
    const calib::LinkParameters& same = back.model.links[frame];
    EXPECT_EQ(same.alpha_rad, link.alpha_rad) << frame;
    EXPECT_EQ(same.theta_rad, link.theta_rad) << frame;
    EXPECT_EQ(same.beta_rad, link.beta_rad) << frame;
    EXPECT_NEAR(same.d_m, link.d_m, kLengthLostMaxMetres) << frame;
    EXPECT_NEAR(same.r_m, link.r_m, kLengthLostMaxMetres) << frame;
  }
  EXPECT_EQ(back.model.joint_types, arm.model.joint_types);
  EXPECT_EQ(back.model.gains, arm.model.gains);
}

TEST_P(EveryArm, IsReadBackWithItsTolerancesRangesAndWeights) {
  const Arm& arm = GetParam().arm;
  const Arm back = read_back(arm);
  EXPECT_EQ(back.name, arm.name);
  for (std::size_t i = 0; i < calib::kErrorParameterCount; ++i) {
    ASSERT_EQ(back.std_errors[i].has_value(), arm.std_errors[i].has_value()) << i;
    EXPECT_NEAR(back.std_errors[i].value_or(0.0), arm.std_errors[i].value_or(0.0), kLengthLostMaxMetres) << i;
  }
  EXPECT_TRUE(back.joint_ranges.lower.isApprox(arm.joint_ranges.lower, 1e-15));
  EXPECT_TRUE(back.joint_ranges.upper.isApprox(arm.joint_ranges.upper, 1e-15));
  EXPECT_TRUE(back.joint_speeds_max.isApprox(arm.joint_speeds_max, 1e-15));
  for (std::size_t frame = 0; frame < calib::kFrameCount; ++frame) {
    EXPECT_EQ(back.model.masses[frame].mass_kg, arm.model.masses[frame].mass_kg);
    expect_near(back.model.masses[frame].center_in_frame_m, arm.model.masses[frame].center_in_frame_m);
  }
  EXPECT_EQ(back.model.compliance_rad_per_nm, arm.model.compliance_rad_per_nm);
  EXPECT_EQ(back.model.down_in_frame_1, arm.model.down_in_frame_1);
  EXPECT_EQ(back.nongeometric_std, arm.nongeometric_std);
  for (std::size_t joint = 0; joint < calib::kJointCount; ++joint) {
    EXPECT_EQ(back.model.harmonics_rad[joint].cos, arm.model.harmonics_rad[joint].cos);
    EXPECT_EQ(back.model.harmonics_rad[joint].sin, arm.model.harmonics_rad[joint].sin);
    EXPECT_EQ(back.model.ripples_rad[joint].cos, arm.model.ripples_rad[joint].cos);
    EXPECT_EQ(back.model.ripples_rad[joint].sin, arm.model.ripples_rad[joint].sin);
  }
  EXPECT_EQ(back.model.ripple_periods_per_turn, arm.model.ripple_periods_per_turn);
  EXPECT_EQ(back.gears.std_rad(), arm.gears.std_rad());
  ASSERT_EQ(back.growth.has_value(), arm.growth.has_value());
  if (!arm.growth) return;
  EXPECT_EQ(back.growth->expansion_per_k, arm.growth->expansion_per_k);
  EXPECT_EQ(back.growth->rise_k, arm.growth->rise_k);
}

TEST_P(EveryArm, IsReadBackWithItsBodies) {
  const Arm& arm = GetParam().arm;
  const Arm back = read_back(arm);
  ASSERT_EQ(back.bodies.size(), arm.bodies.size());
  for (std::size_t i = 0; i < arm.bodies.size(); ++i) {
    EXPECT_EQ(back.bodies[i].name, arm.bodies[i].name);
    EXPECT_EQ(back.bodies[i].frame, arm.bodies[i].frame);
    expect_near(back.bodies[i].from_m, arm.bodies[i].from_m);
    expect_near(back.bodies[i].to_m, arm.bodies[i].to_m);
    EXPECT_NEAR(back.bodies[i].radius_m, arm.bodies[i].radius_m, kLengthLostMaxMetres);
  }
}

TEST_P(EveryArm, PutsItsTipAtTheSamePlaceWhenReadBack) {
  const Arm& arm = GetParam().arm;
  const Arm back = read_back(arm);
  std::mt19937_64 chance(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    calib::JointVector joints;
    for (int joint = 0; joint < calib::kJointCount; ++joint) {
      joints[joint] = std::lerp(arm.joint_ranges.lower[joint], arm.joint_ranges.upper[joint], share(chance));
    }
    const Eigen::Vector3d tip_m = calib::forward_kinematics(arm.model, joints).translation();
    EXPECT_LT((calib::forward_kinematics(back.model, joints).translation() - tip_m).norm(), 2e-15);
  }
}

TEST_P(EveryArm, IsWrittenTheSameAgain) {
  const std::string document = arm_document(GetParam().arm);
  const Folder folder;
  EXPECT_EQ(arm_document(read_arm(folder.write("arm.json", document))), document);
}

TEST(ArmDocument, KeepsTheShortNumbersOfTheFileItCameFrom) {
  const std::string document = arm_document(shipped_arm("tx90"));
  for (const char* text : {R"({"j":0,"theta_rad":0.0,"r_mm":149.6})", R"("r_mm":318.9)", "[-130.0,147.5]",
                           R"("std_compliance_rad_per_nm":[0.0,1e-06,3e-06,3e-06,5e-06,8e-06])"}) {
    EXPECT_THAT(document, testing::HasSubstr(text));
  }
}

TEST(ArmDocument, NamesTheRobotThatWasCalibratedWhereItIsKnown) {
  Arm arm = shipped_arm("tx90");
  EXPECT_THAT(arm_document(arm), testing::HasSubstr(R"("schema": "touchcal/arm/4")"))
      << "an earlier one reads it";
  arm.serial = "F10_12A";
  const std::string document = arm_document(arm);
  EXPECT_THAT(document, testing::HasSubstr(R"("schema": "touchcal/arm/5")"));
  EXPECT_EQ(read_arm_text("arm.json", document).serial, arm.serial);
  EXPECT_EQ(arm_document(read_arm_text("arm.json", document)), document);
}

TEST(ArmDocument, OfAnArmThatIsNoNumberIsAMistakeOfOurOwn) {
  Arm arm = shipped_arm("tx90");
  arm.model.links[3].d_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(arm_document(arm), std::logic_error);
  arm = shipped_arm("tx90");
  arm.model.links[3].alpha_rad = std::numeric_limits<double>::infinity();
  EXPECT_THROW(arm_document(arm), std::logic_error);
}

}  // namespace
}  // namespace cell
