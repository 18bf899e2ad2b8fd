#include "calib_core/inverse_kinematics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace calib {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kTurn = 2.0 * std::numbers::pi;

const LinkParameters& link(const KinematicModel& model, int frame) {
  return model.links[static_cast<std::size_t>(frame)];
}

/// The nearest number of quarter turns, 0 to 3.
int quarter_turns(double angle_rad) {
  const auto quarters = std::lround(angle_rad / (kTurn / 4.0));
  return static_cast<int>(((quarters % 4) + 4) % 4);
}

bool is_sideways(double alpha_rad) { return quarter_turns(alpha_rad) % 2 == 1; }

/// sin of a sideways alpha: +1 or -1.
double side(double alpha_rad) { return quarter_turns(alpha_rad) == 1 ? 1.0 : -1.0; }

bool is_of_this_family(const KinematicModel& model) {
  constexpr double kSmallErrorRad = 0.1;
  const bool revolute =
      std::ranges::all_of(model.joint_types, [](JointType type) { return type == JointType::kRevolute; });
  if (!revolute || quarter_turns(link(model, 3).alpha_rad) != 0) return false;
  for (const int frame : {2, 4, 5, 6}) {
    if (!is_sideways(link(model, frame).alpha_rad)) return false;
  }
  for (int frame = 2; frame <= 6; ++frame) {
    const LinkParameters& here = link(model, frame);
    const double off = std::remainder(here.alpha_rad, kTurn / 4.0);
    if (std::abs(off) > kSmallErrorRad || std::abs(here.beta_rad) > kSmallErrorRad) return false;
  }
  return true;
}

using JointAngles = std::array<double, kJointCount>;  // theta_j whole, offset and gain not yet taken out

/// Joints 1 to 3 that put the wrist centre at `wrist_m`, given in frame 1 at theta_1 = 0.
std::vector<std::array<double, 3>> place_wrist(const KinematicModel& model, const Eigen::Vector3d& wrist_m) {
  const double side2 = side(link(model, 2).alpha_rad), side4 = side(link(model, 4).alpha_rad);
  // Seen along joint 2's axis: the upper arm is (upper, 0), the forearm ends at Rot(theta_3) forearm.
  const double upper_m = link(model, 3).d_m;
  const Eigen::Vector2d forearm_m(link(model, 4).d_m, -side4 * link(model, 4).r_m);
  const double lateral_m = -side2 * (link(model, 2).r_m + link(model, 3).r_m);
  const double radial_squared = wrist_m.head<2>().squaredNorm() - lateral_m * lateral_m;
  if (radial_squared < 0.0) return {};

  std::vector<std::array<double, 3>> solutions;
  for (const double shoulder : {1.0, -1.0}) {
    const double radial_m = shoulder * std::sqrt(radial_squared);
    const double theta1 = std::atan2(wrist_m.y(), wrist_m.x()) - std::atan2(lateral_m, radial_m);
    const Eigen::Vector2d target_m(radial_m - link(model, 2).d_m, side2 * wrist_m.z());
    const double cosine = (target_m.squaredNorm() - upper_m * upper_m - forearm_m.squaredNorm()) /
                          (2.0 * upper_m * forearm_m.norm());
    if (!(std::abs(cosine) <= 1.0)) continue;
    for (const double elbow : {1.0, -1.0}) {
      const double theta3 = elbow * std::acos(cosine) - std::atan2(forearm_m.y(), forearm_m.x());
      const Eigen::Vector2d reach_m = Eigen::Vector2d(upper_m, 0.0) + Eigen::Rotation2Dd(theta3) * forearm_m;
      const double theta2 = std::atan2(target_m.y(), target_m.x()) - std::atan2(reach_m.y(), reach_m.x());
      solutions.push_back({theta1, theta2, theta3});
    }
  }
  return solutions;
}

Eigen::Matrix3d about_x(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).matrix(); }
Eigen::Matrix3d about_z(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix(); }

/// Joints 4 to 6 that give Rot(z,theta4) Rot(x,alpha5) Rot(z,theta5) Rot(x,alpha6) Rot(z,theta6) = rotation.
std::array<std::array<double, 3>, 2> turn_wrist(const KinematicModel& model,
                                                const Eigen::Matrix3d& rotation) {
  const double side5 = side(link(model, 5).alpha_rad), side6 = side(link(model, 6).alpha_rad);
  const double sine = std::hypot(rotation(0, 2), rotation(1, 2));
  const bool straight = sine < 1e-12;
  std::array<std::array<double, 3>, 2> solutions;
  for (const double wrist : {1.0, -1.0}) {
    const double theta5 = std::atan2(wrist * sine, -side5 * side6 * rotation(2, 2));
    const double theta4 = straight
                              ? link(model, 4).theta_rad
                              : std::atan2(wrist * side6 * rotation(1, 2), wrist * side6 * rotation(0, 2));
    const Eigen::Matrix3d rest =
        (about_z(theta4) * about_x(side5 * kTurn / 4.0) * about_z(theta5) * about_x(side6 * kTurn / 4.0))
            .transpose() *
        rotation;
    solutions[wrist > 0.0 ? 0 : 1] = {theta4, theta5, std::atan2(rest(1, 0), rest(0, 0))};
  }
  return solutions;
}

/// Every combination of the whole turns of the joints that lies in the ranges.
void add_turns(const JointVector& joints, const KinematicModel& model, const JointRanges& ranges,
               std::vector<JointVector>& found) {
  std::vector<JointVector> turned{joints};
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double turn = kTurn / std::abs(model.gains[static_cast<std::size_t>(joint)]);
    std::vector<JointVector> next;
    for (JointVector candidate : turned) {
      candidate[joint] -= turn * std::floor((candidate[joint] - ranges.lower[joint]) / turn);
      for (; candidate[joint] <= ranges.upper[joint]; candidate[joint] += turn) next.push_back(candidate);
    }
    turned = std::move(next);
  }
  std::ranges::copy_if(turned, std::back_inserter(found),
                       [&](const JointVector& candidate) { return ranges.contains(candidate); });
}

Vector6 pose_error(const Eigen::Isometry3d& wanted, const Eigen::Isometry3d& reached) {
  const Eigen::AngleAxisd turn(wanted.linear() * reached.linear().transpose());
  return (Vector6() << wanted.translation() - reached.translation(), turn.angle() * turn.axis()).finished();
}

bool reaches(const KinematicModel& model, const JointVector& joints,
             const Eigen::Isometry3d& block_from_tip) {
  const Eigen::Isometry3d reached = forward_kinematics(model, joints);
  return (reached.translation() - block_from_tip.translation()).norm() < kPoseErrorMax &&
         (reached.linear() - block_from_tip.linear()).norm() < kPoseErrorMax;
}

}  // namespace

Eigen::Matrix<double, 6, kJointCount> pose_jacobian(const KinematicModel& model, const Chain& chain) {
  Eigen::Matrix<double, 6, kJointCount> jacobian;
  jacobian.topRows<3>() = tip_jacobian(model, chain);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    const bool turns = model.joint_types[index] == JointType::kRevolute;
    jacobian.col(joint).tail<3>() =
        (turns ? model.gains[index] : 0.0) * chain.block_from_frame[index + 1].linear().col(2);
  }
  return jacobian;
}

std::optional<JointVector> solve_near(const KinematicModel& model, const Eigen::Isometry3d& block_from_tip,
                                      const JointVector& start) {
  constexpr int kStepsMax = 40;
  constexpr double kStepMaxRad = 0.3;  // of any joint: a longer one may land on another branch
  constexpr double kErrorSmall = 1e-13;
  JointVector joints = start;
  for (int step = 0; step < kStepsMax; ++step) {
    const Chain chain = forward_chain(model, joints);
    const Vector6 error = pose_error(block_from_tip, chain.block_from_frame.back());
    if (!error.allFinite()) return std::nullopt;
    if (error.norm() < kErrorSmall) return joints;
    // Damped in proportion to what is missing: pure Newton near the solution, bounded far from it.
    const auto jacobian = pose_jacobian(model, chain);
    const double damping = 1e-2 * error.squaredNorm();
    const Eigen::Matrix<double, 6, 6> normal =
        jacobian.transpose() * jacobian + damping * Eigen::Matrix<double, 6, 6>::Identity();
    JointVector move = normal.ldlt().solve(jacobian.transpose() * error);
    move *= std::min(1.0, kStepMaxRad / std::max(move.cwiseAbs().maxCoeff(), 1e-300));
    joints += move;
    if (move.norm() < kErrorSmall) break;
  }
  return reaches(model, joints, block_from_tip) ? std::optional(joints) : std::nullopt;
}

std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip) {
  if (!is_of_this_family(model)) return {};

  // Peel off what comes before joint 1's turn and after joint 6's.
  const Eigen::Isometry3d block_from_frame1 =
      frame_transform(link(model, 0)) * frame_transform({.alpha_rad = link(model, 1).alpha_rad,
                                                         .d_m = link(model, 1).d_m,
                                                         .r_m = link(model, 1).r_m,
                                                         .beta_rad = link(model, 1).beta_rad});
  const Eigen::Isometry3d frame1_from_wrist =
      block_from_frame1.inverse() * block_from_tip * frame_transform(link(model, 7)).inverse();

  std::vector<JointVector> found;
  for (const auto& [theta1, theta2, theta3] : place_wrist(model, frame1_from_wrist.translation())) {
    const Eigen::Matrix3d frame1_from_forearm =
        about_z(theta1) * about_x(side(link(model, 2).alpha_rad) * kTurn / 4.0) * about_z(theta2 + theta3) *
        about_x(side(link(model, 4).alpha_rad) * kTurn / 4.0);
    for (const auto& [theta4, theta5, theta6] :
         turn_wrist(model, frame1_from_forearm.transpose() * frame1_from_wrist.linear())) {
      JointVector joints(theta1, theta2, theta3, theta4, theta5, theta6);
      for (int joint = 0; joint < kJointCount; ++joint) {
        joints[joint] = std::remainder(joints[joint] - link(model, joint + 1).theta_rad, kTurn) /
                        model.gains[static_cast<std::size_t>(joint)];
      }
      if (!reaches(model, joints, block_from_tip)) {
        const auto polished = solve_near(model, block_from_tip, joints);
        if (!polished) continue;
        joints = *polished;
      }
      add_turns(joints, model, ranges, found);
    }
  }
  return found;
}

}  // namespace calib
