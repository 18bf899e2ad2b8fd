#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "drive_runs.hpp"
#include "sim_controller/val3_system.hpp"
#include "sim_controller/val3_units.hpp"

namespace sim::testing {

inline constexpr val3::Mdesc kSlow{.tvel = 20.0, .blend = val3::Blend::kOff};
inline constexpr val3::Trsf kProbeTool{.z = 218.9};

/// A powered cell in remote mode, the arm over a face.
class Val3Cell : public ::testing::Test {
 protected:
  explicit Val3Cell(Val3SystemOptions options = {}) : system(plant(), cabinet, std::move(options)) {
    cabinet.panel.powered = true;
    displace(cabinet.drives, search().approach);
    ticks(10);
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) system.tick();
  }
  void until_empty() {
    for (int i = 0; i < kTicksMax && !system.is_empty(); ++i) system.tick();
    EXPECT_TRUE(system.is_empty());
  }
  static val3::MoveOrder joint_move(const calib::JointVector& to) {
    return {.to = val3_from_joints(to), .descriptor = {.blend = val3::Blend::kOff}};
  }
  /// A line of the probe's ball.
  val3::MoveOrder line_to(const calib::JointVector& to) {
    val3::MoveOrder order{.shape = val3::MoveOrder::Shape::kLine, .to = val3_from_joints(to)};
    order.tool = kProbeTool;
    order.to_pose = val3_from_pose(system.arm().world_from_flange(to) * pose_from_val3(kProbeTool));
    order.descriptor = kSlow;
    return order;
  }

  /// 12 mm down the search, before the face.
  static calib::JointVector above_face() {
    const ToolPath line = straight_line(plant(), search().approach, search().search_end);
    return posture(line.path, kFreeMetres / line.length_m);
  }
  static calib::JointVector clear() { return search().waypoints.back(); }

  static constexpr double kFreeMetres = 0.012;
  Cabinet cabinet = make_cabinet(plant(), 1);
  Val3System system;
};

}  // namespace sim::testing
