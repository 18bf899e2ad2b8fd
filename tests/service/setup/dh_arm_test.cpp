#include "service/setup/dh_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <sstream>

#include "calib_core/geometry/units.hpp"
#include "config/arm_file.hpp"
#include "config/arm_writer.hpp"
#include "service/exports/dh_tables.hpp"
#include "tests/service/exports/exported_arms.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

void expect_same_model(const calib::KinematicModel& theirs, const std::string& csv) {
  const MadeArm made = arm_of_dh("test.csv", csv);
  const Arm read = read_arm_text("made", arm_document(made.arm));
  for (const calib::JointVector& joints : postures(made.arm)) {
    const Eigen::Isometry3d want = calib::forward_kinematics(theirs, joints);
    const Eigen::Isometry3d have = calib::forward_kinematics(rigid(read).model, joints);
    EXPECT_LT((want.translation() - have.translation()).norm(), calib::kPositionErrorMaxMetres);
    EXPECT_LT((want.linear() - have.linear()).norm(), 1e-9);
  }
}

std::string without_rows_of(const std::string& csv, const std::string& convention) {
  std::istringstream lines(csv);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with(convention + ",")) kept += line + "\n";
  return kept;
}

TEST(DhArm, HasThePosesOfEachShippedArmExportedAndReadBackByEitherConvention) {
  for (const char* name : {"tx90", "tx60", "three-parallel"}) {
    SCOPED_TRACE(name);
    Arm arm = calibrated(shipped_arm(name));
    arm.model.gains[4] = -1.0;
    const std::string csv = dh_csv(arm, "a test's arm");
    expect_same_model(rigid(arm).model, csv);
    expect_same_model(rigid(arm).model, without_rows_of(csv, "modified"));
    expect_same_model(rigid(arm).model, without_rows_of(csv, "standard"));
  }
}

TEST(DhArm, AnExportedArmHasItsPlaceAndItsProbeAndHangsAsItDid) {
  for (const char* name : {"tx90", "tx60"}) {
    const Arm shipped = shipped_arm(name);
    const MadeArm made = arm_of_dh("exported.csv", dh_csv(shipped, "a test's arm"), "");
    EXPECT_TRUE(made.is_placed);
    EXPECT_LT((made.arm.model.down_in_frame_1 - shipped.model.down_in_frame_1).norm(), 1e-9) << name;
  }
  std::string plain = "theta_deg,d_mm,a_mm,alpha_deg\n";
  for (int row = 0; row < 6; ++row) plain += "0,100,100,90\n";
  EXPECT_FALSE(arm_of_dh("plain.csv", plain, "standard").is_placed);
}

struct PlainRow {
  double theta_rad, d_m, a_m, alpha_rad;
};
const std::vector<PlainRow> kPlainRows{{0.1, 0.34, 0.02, -1.5}, {-1.4, 0.0, 0.4, 0.0},
                                       {0.3, 0.03, 0.05, -1.6}, {0.0, 0.42, 0.0, 1.55},
                                       {0.2, 0.0, 0.01, -1.57}, {3.1, 0.09, 0.0, 0.0}};

/// By the words of the two conventions.
Eigen::Isometry3d product_of_rows(bool is_standard, const calib::JointVector& joints) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < kPlainRows.size(); ++i) {
    const auto& [theta, d, a, alpha] = kPlainRows[i];
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity(), link = Eigen::Isometry3d::Identity();
    turn.rotate(Eigen::AngleAxisd(theta + joints[static_cast<Eigen::Index>(i)], Eigen::Vector3d::UnitZ()));
    turn.translate(Eigen::Vector3d(0.0, 0.0, d));
    link.translate(Eigen::Vector3d(a, 0.0, 0.0));
    link.rotate(Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitX()));
    pose = pose * (is_standard ? turn * link : link * turn);
  }
  return pose;
}

TEST(DhArm, HasThePosesOfAPlainTableByEitherConventionInAnyUnits) {
  std::string si = "alpha_rad, a_m, theta_rad, d_m\n\n# a comment\n",
              shop = "theta_deg,d_mm,a_mm,alpha_deg\n";
  for (const PlainRow& row : kPlainRows) {
    si += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g}\r\n", row.alpha_rad, row.a_m, row.theta_rad, row.d_m);
    shop += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g}\n", row.theta_rad / calib::kRadiansPerDegree,
                        1e3 * row.d_m, 1e3 * row.a_m, row.alpha_rad / calib::kRadiansPerDegree);
  }
  for (const bool is_standard : {true, false}) {
    for (const std::string& text : {si, shop}) {
      const MadeArm made = arm_of_dh("plain.csv", text, is_standard ? "standard" : "modified");
      for (const calib::JointVector& joints : postures(made.arm)) {
        const Eigen::Isometry3d theirs = product_of_rows(is_standard, joints);
        const Eigen::Isometry3d ours = calib::forward_kinematics(made.arm.model, joints);
        EXPECT_LT((theirs.matrix() - ours.matrix()).norm(), 1e-9) << is_standard;
      }
    }
  }
}

std::string dh_refusal(const std::string& text, const std::string& convention = "standard") {
  return error_of([&] { arm_of_dh("table.csv", text, convention); }).what();
}

TEST(DhArm, RefusesTablesThatAreNoArmAndNamesTheLine) {
  const std::string row = "0,0,0,0\n", head = "theta_deg,d_mm,a_mm,alpha_deg\n";
  EXPECT_THAT(dh_refusal(""), HasSubstr("no rows"));
  EXPECT_THAT(dh_refusal(head + row), HasSubstr("has 1 rows; an arm has six"));
  EXPECT_THAT(dh_refusal(head + "0,0,x,0\n" + row + row + row + row + row),
              HasSubstr("line 2: a_mm is \"x\""));
  EXPECT_THAT(dh_refusal(head + "0,inf,0,0\n" + row + row + row + row + row), HasSubstr("finite"));
  EXPECT_THAT(dh_refusal(head + "0,0,0\n"), HasSubstr("line 2: has 3 values for 4 columns"));
  EXPECT_THAT(dh_refusal("theta_deg,d_mm,a_mm\n0,0,0\n0,0,0\n0,0,0\n0,0,0\n0,0,0\n0,0,0\n"),
              HasSubstr("no column \"alpha\""));
  EXPECT_THAT(dh_refusal(head + row + row + row + row + row + row, ""), HasSubstr("--dh-convention"));
  EXPECT_THAT(dh_refusal(head + row + row + row + row + row + row + "0,0,5,0\n"), HasSubstr("line 8"));
  EXPECT_THAT(dh_refusal(dh_csv(sliding(shipped_arm("tx90")), "slides")), HasSubstr("prismatic"));
}

TEST(DhArm, DemandsAUnitAndRefusesAnArmThatIsAThousandTimesTooSmallOrTooLarge) {
  const auto six = [](const std::string& head, const std::string& row) {
    std::string text = head + "\n";
    for (int i = 0; i < 6; ++i) text += row + "\n";
    return text;
  };
  EXPECT_THAT(
      dh_refusal(six("theta,d_mm,a_mm,alpha_deg", "0,100,100,90")),
      HasSubstr("column \"theta\" has no unit, which is not guessed; name it theta_deg or theta_rad"));
  EXPECT_THAT(dh_refusal(six("theta_deg,d,a_mm,alpha_deg", "0,100,100,90")),
              HasSubstr("name it d_mm or d_m"));
  EXPECT_THAT(dh_refusal(six("theta_deg,d_mm,a_mm,alpha_deg", "0,0.1,0.1,90")),
              AllOf(HasSubstr("is the unit another one?"), HasSubstr("in metres in d_m and a_m")));
  EXPECT_THAT(dh_refusal(six("theta_deg,d_m,a_m,alpha_deg", "0,100,100,90")), HasSubstr("from 0.1 to 5 m"));
  EXPECT_THAT(dh_refusal(six("theta_deg,d_mm,a_mm,alpha_deg", "0,100,100,-1.5708")),
              AllOf(HasSubstr("line 2"), HasSubstr("quarter turn in radians")));
}

TEST(DhArm, HasTheRadiiThatAPersonHasMeasured) {
  std::string text = "theta_deg,d_m,a_m,alpha_deg\n";
  for (int row = 0; row < 6; ++row) text += "0,0.2,0,90\n";
  MadeArm made = arm_of_dh("measured.csv", text, "standard");
  set_body_radii(made, {80.0, 60.0, 60.0, 45.0, 40.0, 35.0});
  EXPECT_EQ(made.arm.bodies[3].radius_m, 0.045);
  EXPECT_EQ(made.arm.bodies[3].name, "forearm");
  EXPECT_THAT(made.remarks, ::testing::Not(Contains(HasSubstr("guessed"))));
}

TEST(DhArm, HasBodiesThatGrowWithTheArmAndSaysThatTheyAreGuessed) {
  for (const double scale : {0.3, 1.0, 3.0}) {
    std::string text = "theta_deg,d_m,a_m,alpha_deg\n";
    for (int row = 0; row < 6; ++row) text += fmt::format("0,{},0,90\n", (row == 5 ? 0.04 : 0.24) * scale);
    const MadeArm made = arm_of_dh("scaled.csv", text, "standard");
    ASSERT_EQ(made.arm.bodies.size(), kMadeRadiusShares.size());
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(made.arm.bodies[i].radius_m, kMadeRadiusShares[i] * 1.0 * scale, 1e-9);
    if (scale >= 1.0) {
      EXPECT_NEAR(made.arm.bodies[4].radius_m, kMadeRadiusOfLengthMax * 0.04 * scale, 1e-9) << "it is short";
    }
    EXPECT_THAT(made.arm.bodies.front().name, HasSubstr("(guessed)"));
    EXPECT_THAT(made.remarks, Contains(AllOf(HasSubstr("guessed"), HasSubstr("before it moves"))));
  }
}

}  // namespace
}  // namespace cell
