#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

/// A move before it is made: its path, and how fast each part of it may be.
namespace sim {

/// Period of motion and slow inputs on a CS8.
inline constexpr double kTickSeconds = 0.004;
/// A joint's ramp from standstill to its full speed, at an acceleration share of 1.
inline constexpr double kJointRampSeconds = 0.4;
/// What reset_motion() brakes with: the tool centre at least this hard (joints harder by the same factor) ...
inline constexpr double kResetDecelerationMetresPerSecond2 = 2.0;
/// ... and harder where that would take longer than this from the move's top speed to standstill.
inline constexpr double kResetSeconds = 0.125;

/// How fast an arm is in manual mode at most: its tool centre, and a joint (arm manual RX160, 1.4.2).
inline constexpr double kManualTipMetresPerSecond = 0.25;
inline constexpr double kManualJointRadiansPerSecond = 45.0 * std::numbers::pi / 180.0;

/// How a move is made, as VAL3's mdesc says it (manual 6, page 155): shares of what each joint does
/// nominally, and caps of the tool. The nominal speeds are those of the arm file; a joint's nominal
/// acceleration takes it there within kJointRampSeconds.
struct MotionDescriptor {
  static constexpr double kNoCap = std::numeric_limits<double>::infinity();
  double joint_speed_share = 1.0;
  double joint_acceleration_share = 1.0;
  double joint_deceleration_share = 1.0;
  double tip_speed_m_s = kNoCap;
  double turn_speed_rad_s = kNoCap;
  double tip_acceleration_m_s2 = kNoCap;  // speeding up and slowing down; VAL3 has none
};

/// As the C++ twin makes its moves: joints at what they can do, the tool centre no faster than this.
MotionDescriptor at_tip_speed(double tip_speed_m_s);

/// A queued motion: a trapezoid in progress (0 to 1, even along the stretch) that begins and ends at
/// standstill.
struct Move {
  std::shared_ptr<const Path> path;
  double from = 0.0;  // the stretch of the path that is travelled; back when `to` is less
  double to = 1.0;
  double top_rate = 0.0;  // progress per second, at monitor speed 100 %
  double manual_rate = std::numeric_limits<double>::infinity();  // and in manual mode no more than this
  double acceleration = 0.0;        // progress per second^2; no monitor speed scales it
  double deceleration = 0.0;        // likewise
  double reset_deceleration = 0.0;  // of reset_motion()
  bool is_impossible = false;       // not begun: kImpossibleMoveError when it is its turn
  bool ends_in_error = false;       // the arm cannot follow farther: kImpossibleMoveError when it is there
  bool is_connection = false;       // back to where the next move's path was left
  double id = 0.0;                  // of getMoveId
  std::string why_impossible;       // for the log; may be empty

  /// Progress along the path after a share of the move.
  [[nodiscard]] double along_path(double progress) const { return from + (to - from) * progress; }
};

/// The move over a stretch with that tool (its pose in the nominal arm's frame 7).
Move plan_move(const Plant& plant, Stretch stretch, const MotionDescriptor& how,
               const Eigen::Isometry3d& tip_from_tool = Eigen::Isometry3d::Identity());

/// A move that the arm does not begin. `why`: for the log.
Move impossible_move(const calib::JointVector& at, std::string why = {});

/// The slow joint move back to where a path was left (manual 6, page 145).
Move connection_move(const calib::JointVector& from, const calib::JointVector& to);

}  // namespace sim
