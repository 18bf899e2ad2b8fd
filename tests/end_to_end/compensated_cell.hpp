#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/arm_file.hpp"
#include "config/arm_writer.hpp"
#include "config/truth.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {

/// The demonstration's cell, the arm that its simulator hides as if it were identified, and two targets.
class CompensatedCell : public ::testing::Test {
 protected:
  static constexpr std::size_t kWristFrame = 6;

  void SetUp() override {
    arm_.model = truth_;
    arm_.serial = demo_.arm_serial;
    write("arm.json", cell::arm_document(arm_));
    write("targets.json",
          R"({"schema":"touchcal/targets/1","tool":"gripper","targets":[
             {"name":"pick","joints_deg":[20,30,60,10,50,-20]},
             {"name":"near","joints_deg":[20,30,60,10,3,-20]}]})");
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  static std::string bytes_in(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }
  Finished compensate(const std::string& targets, const std::vector<std::string>& more = {},
                      const std::string& arm = "arm.json") {
    std::vector<std::string> arguments{"touchcal", "compensate", "--cell",    cell_file("demo"),
                                       "--arm",    file(arm),    "--targets", file(targets)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(arguments, folder_ / "call.err").wait();
  }
  void expect_one_line(const Finished& finished, int exit_code, const std::vector<std::string>& parts) {
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
    EXPECT_EQ(finished.out, "");
    EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
    for (const std::string& part : parts) EXPECT_THAT(finished.err, ::testing::HasSubstr(part));
  }
  /// Where the gripper of an arm is, in its own world.
  Eigen::Vector3d gripper_m(const calib::KinematicModel& arm, const nlohmann::json& joints_deg) {
    return gripper_m(arm, joints_deg, demo_.tools.at("gripper").translation());
  }
  /// The same with its tip here in R_6.
  static Eigen::Vector3d gripper_m(const calib::KinematicModel& arm, const nlohmann::json& joints_deg,
                                   const Eigen::Vector3d& tip_m) {
    calib::JointVector joints;
    for (std::size_t i = 0; i < 6; ++i)
      joints[static_cast<Eigen::Index>(i)] = calib::radians_from_degrees(joints_deg.at(i).get<double>());
    return (calib::frame_transform(arm.links[0]) * calib::frame_transform(arm.links[1])).inverse() *
           (calib::forward_chain(arm, joints).block_from_frame[kWristFrame] * tip_m);
  }

  Folder folder_;
  cell::Cell demo_ = shipped_cell("demo");
  cell::Arm arm_ = demo_.arm;
  calib::KinematicModel truth_ =
      cell::true_model(cell::read_truth(cell_folder("demo") + "/truth-real.json"), demo_.arm);
};

}  // namespace touchcal::testing
