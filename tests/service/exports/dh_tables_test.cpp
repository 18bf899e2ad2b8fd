#include "service/exports/dh_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "calib_core/geometry/units.hpp"
#include "tests/service/exports/exported_arms.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct CsvRow {
  std::string convention, joint;
  int number = 0;
  double theta = 0.0, d = 0.0, a = 0.0, alpha = 0.0, beta = 0.0;  // degrees, millimetres
  double gain = 0.0;                                              // 0 where there is none
};

std::vector<CsvRow> read_rows(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<CsvRow> rows;
  bool has_head = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    if (!std::exchange(has_head, true)) {
      EXPECT_EQ(line, "convention,row,joint,theta_deg,d_mm,a_mm,alpha_deg,beta_deg,gain");
      continue;
    }
    std::vector<std::string> cells;
    std::istringstream parts(line + ",");
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    EXPECT_EQ(cells.size(), 9u) << line;
    const auto number = [&cells](std::size_t i) { return cells.at(i).empty() ? 0.0 : std::stod(cells[i]); };
    rows.push_back({cells.at(0), cells.at(2), std::stoi(cells.at(1)), number(3), number(4), number(5),
                    number(6), number(7), number(8)});
  }
  return rows;
}

Eigen::Isometry3d about(double deg, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(calib::radians_from_degrees(deg), axis));
}
Eigen::Isometry3d along(double mm, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::Translation3d(calib::metres_from_mm(mm) * axis));
}

/// By the transform that the file's own comment says.
Eigen::Isometry3d tip_by(const std::vector<CsvRow>& rows, const std::string& convention,
                         const calib::JointVector& joints) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const CsvRow& row : rows) {
    if (row.convention != convention) continue;
    double theta = row.theta, d = row.d;
    if (row.joint == "revolute") theta += row.gain * calib::degrees_from_radians(joints[row.number - 1]);
    if (row.joint == "prismatic") d += row.gain * calib::mm_from_metres(joints[row.number - 1]);
    const Eigen::Isometry3d about_z = about(theta, z) * along(d, z);
    const Eigen::Isometry3d about_x = about(row.beta, y) * about(row.alpha, x) * along(row.a, x);
    pose = pose * (convention == "modified" ? about_x * about_z : about_z * about_x);
  }
  return pose;
}

TEST(DhTables, BothConventionsGiveThePosesOfTheArm) {
  for (const Arm& arm : {calibrated(shipped_arm("tx90")), calibrated(shipped_arm("three-parallel")),
                         sliding(calibrated(shipped_arm("tx60")))}) {
    const std::vector<CsvRow> rows = read_rows(dh_csv(arm, "a test's arm"));
    ASSERT_EQ(rows.size(), 2u * calib::kFrameCount);
    for (const calib::JointVector& joints : postures(arm)) {
      const Eigen::Isometry3d ours = calib::forward_kinematics(rigid(arm).model, joints);
      for (const char* convention : {"modified", "standard"}) {
        const Eigen::Isometry3d theirs = tip_by(rows, convention, joints);
        EXPECT_LT((theirs.matrix() - ours.matrix()).norm(), 1e-9) << arm.name << " " << convention;
      }
    }
  }
}

TEST(DhTables, TheFileSaysWhatItsFiguresMean) {
  const std::string csv = dh_csv(shipped_arm("tx90"), "the calibrated arm of run 7");
  EXPECT_THAT(csv, StartsWith("# tx90: the calibrated arm of run 7\n"));
  EXPECT_THAT(csv,
              HasSubstr("# modified: row j is Rot(y,beta) Rot(x,alpha) Trans(x,a) Rot(z,theta) Trans(z,d)"));
  EXPECT_THAT(csv,
              HasSubstr("# standard: row j is Rot(z,theta) Trans(z,d) Rot(y,beta) Rot(x,alpha) Trans(x,a)"));
  EXPECT_THAT(csv, HasSubstr("modified,2,revolute,-90,0,50,-90,0,1\n"));
}

TEST(DhTables, JsonHasTheSameRows) {
  const Arm arm = calibrated(shipped_arm("tx90"));
  const auto document = nlohmann::json::parse(dh_json(arm, "a test's arm"));
  EXPECT_EQ(document.at("schema"), "touchcal/dh/1");
  EXPECT_EQ(document.at("arm"), "tx90");
  const std::vector<CsvRow> rows = read_rows(dh_csv(arm, "a test's arm"));
  ASSERT_EQ(document.at("rows").size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = document.at("rows")[i];
    EXPECT_EQ(row.at("convention"), rows[i].convention);
    EXPECT_EQ(row.at("row"), rows[i].number);
    EXPECT_EQ(row.at("theta_deg").get<double>(), rows[i].theta);
    EXPECT_EQ(row.at("a_mm").get<double>(), rows[i].a);
    EXPECT_EQ(row.at("gain").is_null(), row.at("joint") == "fixed");
  }
}

}  // namespace
}  // namespace cell
