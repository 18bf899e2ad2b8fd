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
  std::string source;       // what errors call it
  std::string unit_remedy;  // what to do where its lengths are in another unit than they were read in
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

/// Lengths from joint to joint and to the tip together. An arm that is smaller or larger than these bounds
/// is refused: its lengths were given in another unit.
double made_reach_m(const ArmDescription& description);
inline constexpr double kMadeReachMinMetres = 0.1;
inline constexpr double kMadeReachMaxMetres = 5.0;

/// Radius of each body as a share of that, from the shoulder to the flange: a guess, between those of the
/// shipped tx90 and three-parallel, which a person must check. But no thicker than that share of its own
/// length, where it has one.
inline constexpr double kMadeRadiusOfLengthMax = 0.4;
inline constexpr std::array<double, calib::kJointCount> kMadeRadiusShares{0.09, 0.07, 0.07, 0.06, 0.05, 0.04};

/// Radii of its bodies as a person has measured them, millimetres, from the shoulder to the flange: they are
/// guessed no more.
void set_body_radii(MadeArm& made, const std::vector<double>& radii_mm);

/// Ranges and speeds where nobody says them.
calib::JointRanges assumed_ranges();
calib::JointVector assumed_speeds();

/// The arm with what no description has: standard deviations of its errors and figures of its gears as the
/// shipped tx90 has them, bodies along its joints. The remarks say so. ConfigError where it has not the size
/// of an arm.
MadeArm made_arm(const ArmDescription& description, std::vector<std::string> remarks);

}  // namespace cell
