#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "config/cell.hpp"

namespace cell {

/// An arm made of another program's description, in a frame of that description: R_-1 is its base, R_7 its
/// tip, whose z must point out of the flange.
struct MadeArm {
  Arm arm;
  Eigen::Isometry3d base_from_frame1 = Eigen::Isometry3d::Identity();
  std::vector<std::string> remarks;  // what was assumed, a line each
  bool is_placed = false;            // ArmDescription::is_placed
};

/// What turns with a joint and weighs something; in the base, where all joints are at 0.
struct MadeMass {
  int joint = 1;  // 1 to 6
  double mass_kg = 0.0;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
};

struct ArmDescription {
  std::string name;
  calib::KinematicModel model;
  calib::JointRanges ranges;
  calib::JointVector speeds_max;
  std::vector<MadeMass> masses;
  /// The base is the block's frame, whose y points down, and the tip the ball, as in what touchcal exports;
  /// else z of the base points up, as robots are described.
  bool is_placed = false;
  /// Points from the foot to the tip, in the base, where all joints are at 0: a body reaches from each to the
  /// next. The first moves with joint 1.
  std::array<Eigen::Vector3d, calib::kJointCount + 1> joints_and_tip_m;
};

/// Ranges and speeds where nobody says them.
calib::JointRanges assumed_ranges();
calib::JointVector assumed_speeds();

/// The arm with what no description has: standard deviations of its errors and figures of its gears as the
/// shipped tx90 has them, bodies along its joints. The remarks say so.
MadeArm made_arm(const ArmDescription& description, std::vector<std::string> remarks);

}  // namespace cell
