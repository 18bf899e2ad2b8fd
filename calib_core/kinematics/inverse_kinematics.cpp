#include "calib_core/kinematics/inverse_kinematics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

namespace calib {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Sine of joint 5 below which the wrist is straight.
constexpr double kStraightSine = 1e-12;

const LinkParameters& link(const KinematicModel& model, int frame) {
  return model.links[static_cast<std::size_t>(frame)];
}

/// The nearest multiple of a quarter turn, 0 to 3.
int quarter_turns(double angle_rad) {
  const auto quarters = std::lround(angle_rad / (kTurn / 4.0));
  return static_cast<int>(((quarters % 4) + 4) % 4);
}

bool is_sideways(double alpha_rad) { return quarter_turns(alpha_rad) % 2 == 1; }

/// sin of a sideways alpha: +1 or -1.
double side(double alpha_rad) { return quarter_turns(alpha_rad) == 1 ? 1.0 : -1.0; }

constexpr std::array kSideways{2, 4, 5, 6};  // frames

/// A spherical wrist, but for small errors, on an upper arm and a forearm that the closed form can divide by.
bool has_spherical_wrist(const KinematicModel& model) {
  constexpr double kSmallErrorRad = 0.1;
  constexpr double kSmallErrorMetres = 0.020;
  if (quarter_turns(link(model, 3).alpha_rad) != 0) return false;
  if (std::abs(link(model, 3).d_m) < kSmallErrorMetres) return false;
  if (std::hypot(link(model, 4).d_m, link(model, 4).r_m) < kSmallErrorMetres) return false;
  for (const int frame : {5, 6}) {
    if (std::hypot(link(model, frame).d_m, link(model, frame).r_m) > kSmallErrorMetres) return false;
  }
  for (const int frame : kSideways) {
    if (!is_sideways(link(model, frame).alpha_rad)) return false;
  }
  for (int frame = 2; frame <= 6; ++frame) {
    const LinkParameters& here = link(model, frame);
    const double off = std::remainder(here.alpha_rad, kTurn / 4.0);
    if (std::abs(off) > kSmallErrorRad || std::abs(here.beta_rad) > kSmallErrorRad) return false;
  }
  return true;
}

/// Whether the closed form solves the model without a remaining error.
bool closed_form_is_exact(const PreparedModel& prepared) {
  constexpr double kExactRad = 1e-12;
  const KinematicModel& model = prepared.model;
  for (int frame = 2; frame <= kJointCount; ++frame) {
    const LinkParameters& here = link(model, frame);
    if (std::abs(std::remainder(here.alpha_rad, kTurn / 4.0)) > kExactRad || here.beta_rad != 0.0)
      return false;
    if (frame > 4 && (here.d_m != 0.0 || here.r_m != 0.0)) return false;
  }
  return !prepared.is_compliant;
}

/// Rot(z)^-1 and, for a quarter turn of this sine, Rot(x)^-1.
Eigen::Vector3d unturned_z(const std::complex<double>& turn, const Eigen::Vector3d& v) {
  return {turn.real() * v.x() + turn.imag() * v.y(), turn.real() * v.y() - turn.imag() * v.x(), v.z()};
}
Eigen::Vector3d unturned_x(double sine, const Eigen::Vector3d& v) {
  return {v.x(), sine * v.z(), -sine * v.y()};
}

/// (a + ib)(c - id), without the checks for infinity of std::complex.
std::complex<double> times_conjugate(const std::complex<double>& a, const std::complex<double>& b) {
  return {a.real() * b.real() + a.imag() * b.imag(), a.imag() * b.real() - a.real() * b.imag()};
}
std::complex<double> times(const std::complex<double>& a, const std::complex<double>& b) {
  return times_conjugate(a, std::conj(b));
}

/// Appends every combination of full joint turns that is within the ranges.
void add_turns(const JointVector& joints, const JointVector& turns, const JointRanges& ranges,
               std::vector<JointVector>& found) {
  std::vector<JointVector> turned{joints};
  for (int joint = 0; joint < kJointCount; ++joint) {
    std::vector<JointVector> next;
    for (JointVector candidate : turned) {
      candidate[joint] -= turns[joint] * std::floor((candidate[joint] - ranges.lower[joint]) / turns[joint]);
      for (; candidate[joint] <= ranges.upper[joint]; candidate[joint] += turns[joint]) {
        next.push_back(candidate);
      }
    }
    turned = std::move(next);
  }
  std::ranges::copy_if(turned, std::back_inserter(found),
                       [&](const JointVector& candidate) { return ranges.contains(candidate); });
}

}  // namespace

struct InverseKinematics::Branch {
  double shoulder = 1.0, elbow = 1.0, wrist = 1.0;
};

struct InverseKinematics::ArmSolution {
  double theta1 = 0.0, theta2 = 0.0, theta3 = 0.0;
  std::complex<double> turn1, turn23;  // of theta1 and of theta2 + theta3
  bool shoulders_meet = false, elbows_meet = false;
};

InverseKinematics::InverseKinematics(const KinematicModel& model) : prepared_(prepare(model)) {
  for (int joint = 0; joint < kJointCount; ++joint) {
    offsets_rad_[joint] = std::remainder(link(model, joint + 1).theta_rad, kTurn);
    turns_[joint] = kTurn / std::abs(model.gains[static_cast<std::size_t>(joint)]);
  }
  const bool slides =
      std::ranges::any_of(model.joint_types, [](JointType type) { return type == JointType::kPrismatic; });
  if (slides) return;
  if (!has_spherical_wrist(model)) {
    structure_ = Structure::kGeneral;
    numerical_.emplace(model);
    return;
  }
  structure_ = closed_form_is_exact(prepared_) ? Structure::kSphericalWrist : Structure::kNearSphericalWrist;
  // Constant transforms before the rotation of joint 1 and after the rotation of joint 6.
  LinkParameters until_joint1 = link(model, 1);
  until_joint1.theta_rad = 0.0;
  frame1_from_block_ = (frame_transform(link(model, 0)) * frame_transform(until_joint1)).inverse();
  tip_from_wrist_ = frame_transform(link(model, 7)).inverse();
  side2_ = side(link(model, 2).alpha_rad);
  side4_ = side(link(model, 4).alpha_rad);
  side5_ = side(link(model, 5).alpha_rad);
  side6_ = side(link(model, 6).alpha_rad);
  // Seen along the axis of joint 2: the upper arm is (upper, 0), the forearm ends at Rot(theta_3) forearm.
  upper_m_ = link(model, 3).d_m;
  lateral_m_ = -side2_ * (link(model, 2).r_m + link(model, 3).r_m);
  const std::complex<double> forearm(link(model, 4).d_m, -side4_ * link(model, 4).r_m);
  forearm_m_ = std::abs(forearm);
  forearm_direction_ = forearm / forearm_m_;
}

Eigen::Isometry3d InverseKinematics::frame1_from_wrist(const Eigen::Isometry3d& block_from_tip) const {
  return frame1_from_block_ * block_from_tip * tip_from_wrist_;
}

/// Joints 1 to 3 that bring the wrist centre to `wrist_m`, given in frame 1 at theta_1 = 0.
std::optional<InverseKinematics::ArmSolution> InverseKinematics::solve_arm(const Eigen::Vector3d& wrist_m,
                                                                           const Branch& branch) const {
  constexpr double kRounding = 1e-11;  // metres, and of the cosine: still within reach
  ArmSolution arm;
  const double from_axis_squared = wrist_m.head<2>().squaredNorm();
  const double radial_squared = from_axis_squared - lateral_m_ * lateral_m_;
  if (!(radial_squared >= -kRounding * std::abs(lateral_m_))) return std::nullopt;
  const double radial_m = branch.shoulder * std::sqrt(std::max(radial_squared, 0.0));
  arm.shoulders_meet = radial_m == 0.0;
  arm.turn1 = from_axis_squared > 0.0
                  ? times_conjugate({wrist_m.x(), wrist_m.y()}, {radial_m, lateral_m_}) / from_axis_squared
                  : std::complex<double>(1.0);

  const std::complex<double> target_m(radial_m - link(prepared_.model, 2).d_m, side2_ * wrist_m.z());
  const double target_squared = std::norm(target_m);
  const double cosine =
      (target_squared - upper_m_ * upper_m_ - forearm_m_ * forearm_m_) / (2.0 * upper_m_ * forearm_m_);
  if (!(std::abs(cosine) <= 1.0 + kRounding)) return std::nullopt;
  const double sine = std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0));
  arm.elbows_meet = sine == 0.0;
  const std::complex<double> bend(std::clamp(cosine, -1.0, 1.0), branch.elbow * sine);
  const std::complex<double> turn3 = times_conjugate(bend, forearm_direction_);
  const std::complex<double> reach_m = upper_m_ + forearm_m_ * bend;
  const std::complex<double> turn2 =
      target_squared > 0.0 ? times_conjugate(target_m, reach_m) / target_squared : std::complex<double>(1.0);
  arm.turn23 = times(turn2, turn3);
  arm.theta1 = std::arg(arm.turn1);
  arm.theta2 = std::arg(turn2);
  arm.theta3 = std::arg(turn3);
  return arm;
}

/// All joint positions. Joints 4 to 6 satisfy Rot(z,theta4) Rot(x,alpha5) Rot(z,theta5) Rot(x,alpha6)
/// Rot(z,theta6) = the part of `frame1_from_frame6` (at theta_1 = 0) that joints 1 to 3 do not contribute.
JointVector InverseKinematics::solve_wrist(const Eigen::Matrix3d& frame1_from_frame6, const ArmSolution& arm,
                                           double wrist_sign, bool& is_straight) const {
  const auto seen_from_forearm = [&](const Eigen::Vector3d& v) {
    return unturned_x(side4_, unturned_z(arm.turn23, unturned_x(side2_, unturned_z(arm.turn1, v))));
  };
  const Eigen::Vector3d x = seen_from_forearm(frame1_from_frame6.col(0)),
                        z = seen_from_forearm(frame1_from_frame6.col(2));
  const double sine = wrist_sign * std::sqrt(z.x() * z.x() + z.y() * z.y());
  is_straight = std::abs(sine) < kStraightSine;
  const std::complex<double> turn4 =
      is_straight ? std::polar(1.0, offsets_rad_[3]) : std::complex<double>(z.x(), z.y()) * (side6_ / sine);
  const std::complex<double> turn5(-side5_ * side6_ * z.z(), sine);
  const Eigen::Vector3d rest =
      unturned_x(side6_, unturned_z(turn5, unturned_x(side5_, unturned_z(turn4, x))));
  JointVector joints(arm.theta1, arm.theta2, arm.theta3, std::arg(turn4), std::arg(turn5),
                     std::atan2(rest.y(), rest.x()));
  for (int joint = 0; joint < kJointCount; ++joint) {
    double& angle = joints[joint];
    angle -= offsets_rad_[joint];
    if (angle > kTurn / 2.0) angle -= kTurn;
    if (angle < -kTurn / 2.0) angle += kTurn;
    angle /= prepared_.model.gains[static_cast<std::size_t>(joint)];
  }
  return joints;
}

Postures InverseKinematics::solve(const Eigen::Isometry3d& block_from_tip) const {
  Postures found;
  if (structure_ == Structure::kWithPrismaticJoint) return found;
  if (numerical_) return numerical_->solve(block_from_tip);
  const Eigen::Isometry3d wanted = frame1_from_wrist(block_from_tip);
  for (const double shoulder : {1.0, -1.0}) {
    bool shoulders_meet = false;
    for (const double elbow : {1.0, -1.0}) {
      const auto arm = solve_arm(wanted.translation(), {shoulder, elbow});
      if (!arm) break;
      bool is_straight = false;
      found.push_back(solve_wrist(wanted.linear(), *arm, 1.0, is_straight));
      if (!is_straight) found.push_back(solve_wrist(wanted.linear(), *arm, -1.0, is_straight));
      shoulders_meet = arm->shoulders_meet;
      if (arm->elbows_meet) break;
    }
    if (shoulders_meet) break;
  }
  return structure_ == Structure::kSphericalWrist ? found : refined(found, block_from_tip);
}

Postures InverseKinematics::refined(const Postures& rough, const Eigen::Isometry3d& block_from_tip) const {
  constexpr double kSameRad = 1e-7;
  Postures found;
  for (const JointVector& start : rough) {
    const auto joints = solve_near(prepared_, block_from_tip, start);
    const bool is_new = joints && std::ranges::none_of(found, [&](const JointVector& other) {
                          return (other - *joints).cwiseAbs().maxCoeff() < kSameRad;
                        });
    if (is_new) found.push_back(*joints);
  }
  return found;
}

InverseKinematics::Branch InverseKinematics::branch_of(const JointVector& joints) const {
  const auto theta = [&](int joint) {
    return offsets_rad_[joint - 1] +
           prepared_.model.gains[static_cast<std::size_t>(joint - 1)] * joints[joint - 1];
  };
  const std::complex<double> turn2 = std::polar(1.0, theta(2));
  const std::complex<double> bend = times(std::polar(1.0, theta(3)), forearm_direction_);
  const double radial_m = link(prepared_.model, 2).d_m + times(turn2, upper_m_ + forearm_m_ * bend).real();
  return {radial_m >= 0.0 ? 1.0 : -1.0, bend.imag() >= 0.0 ? 1.0 : -1.0,
          std::sin(theta(5)) >= 0.0 ? 1.0 : -1.0};
}

std::optional<JointVector> InverseKinematics::follow(const Eigen::Isometry3d& block_from_tip,
                                                     const JointVector& start) const {
  if (structure_ != Structure::kSphericalWrist) return solve_near(prepared_, block_from_tip, start);
  const Eigen::Isometry3d wanted = frame1_from_wrist(block_from_tip);
  const Branch branch = branch_of(start);
  const auto arm = solve_arm(wanted.translation(), branch);
  if (!arm) return std::nullopt;
  bool is_straight = false;
  JointVector joints = solve_wrist(wanted.linear(), *arm, branch.wrist, is_straight);
  for (int joint = 0; joint < kJointCount; ++joint) {
    joints[joint] += turns_[joint] * std::nearbyint((start[joint] - joints[joint]) / turns_[joint]);
  }
  return joints;
}

std::vector<JointVector> inverse_kinematics(const KinematicModel& model, const JointRanges& ranges,
                                            const Eigen::Isometry3d& block_from_tip) {
  const InverseKinematics inverse(model);
  std::vector<JointVector> found;
  const Postures postures = inverse.solve(block_from_tip);
  for (const JointVector& joints : postures) {
    add_turns(joints, inverse.turns(), ranges, found);
  }
  return found;
}

}  // namespace calib
