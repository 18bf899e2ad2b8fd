#include "calib_core/kinematics/kinematic_model.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/kinematics/gravity.hpp"

namespace calib {
namespace {

CosSin cos_sin(double angle_rad) {
  if (angle_rad == 0.0) return {};  // most angles of a nominal arm are 0
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// The chain of a rigid arm. Each step changes the columns of the previous frame; 4-vectors, as they fill two
/// SIMD registers each.
void compute_rigid_chain(const PreparedModel& prepared, const PreparedJoints& joints, Chain& chain) {
  Eigen::Vector4d x = Eigen::Vector4d::UnitX(), y = Eigen::Vector4d::UnitY(), z = Eigen::Vector4d::UnitZ();
  Eigen::Vector4d origin_m = Eigen::Vector4d::UnitW();
  // Rotates the first axis towards the second.
  const auto turn = [](const CosSin& angle, Eigen::Vector4d& first, Eigen::Vector4d& second) {
    const Eigen::Vector4d turned = angle.cos * first + angle.sin * second;
    second = angle.cos * second - angle.sin * first;
    first = turned;
  };
  for (std::size_t frame = 0; frame < kFrameCount; ++frame) {
    const LinkParameters& link = prepared.model.links[frame];
    CosSin theta = prepared.theta[frame];
    double r_m = link.r_m;
    if (frame > 0 && frame <= kJointCount) {
      const std::size_t joint = frame - 1;
      if (prepared.model.joint_types[joint] == JointType::kRevolute) {
        const CosSin& moved = joints.turned[joint];
        theta = {theta.cos * moved.cos - theta.sin * moved.sin,
                 theta.sin * moved.cos + theta.cos * moved.sin};
      } else {
        r_m += prepared.model.gains[joint] * joints.joints[static_cast<Eigen::Index>(joint)];
      }
    }
    turn(prepared.beta[frame], z, x);
    turn(prepared.alpha[frame], y, z);
    origin_m += link.d_m * x;
    turn(theta, x, y);
    origin_m += r_m * z;
    auto& here = chain.block_from_frame[frame].matrix();
    here.col(0) = x;
    here.col(1) = y;
    here.col(2) = z;
    here.col(3) = origin_m;
  }
}

}  // namespace

Eigen::Isometry3d frame_transform(const LinkParameters& link) {
  const double ca = std::cos(link.alpha_rad), sa = std::sin(link.alpha_rad);
  const double cb = std::cos(link.beta_rad), sb = std::sin(link.beta_rad);
  const double ct = std::cos(link.theta_rad), st = std::sin(link.theta_rad);

  // Rot(y,beta) Rot(x,alpha) by columns; then Rot(z,theta) combines the first two.
  const Eigen::Vector3d x(cb, 0.0, -sb);
  const Eigen::Vector3d y(sb * sa, ca, cb * sa);
  const Eigen::Vector3d z(sb * ca, -sa, cb * ca);

  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear().col(0) = ct * x + st * y;
  transform.linear().col(1) = ct * y - st * x;
  transform.linear().col(2) = z;
  transform.translation() = link.d_m * x + link.r_m * z;
  return transform;
}

PreparedModel prepare(const KinematicModel& model) {
  PreparedModel prepared{.model = model};
  for (std::size_t frame = 0; frame < kFrameCount; ++frame) {
    const LinkParameters& link = model.links[frame];
    prepared.alpha[frame] = cos_sin(link.alpha_rad);
    prepared.beta[frame] = cos_sin(link.beta_rad);
    prepared.theta[frame] = cos_sin(link.theta_rad);
  }
  prepared.has_masses =
      std::ranges::any_of(model.masses, [](const PointMass& m) { return m.mass_kg != 0.0; });
  prepared.is_compliant = std::ranges::any_of(model.compliance_rad_per_nm, [](double c) { return c != 0.0; });
  const auto is_uneven = [](const CosSin& h) { return h.cos != 0.0 || h.sin != 0.0; };
  prepared.has_harmonics = std::ranges::any_of(model.harmonics_rad, is_uneven) ||
                           std::ranges::any_of(model.second_harmonics_rad, is_uneven);
  prepared.has_periods =
      std::ranges::any_of(model.ripple_periods_per_turn, [](double p) { return p != 0.0; });
  prepared.down_in_frame_0 = frame_transform(model.links[1]).linear() * model.down_in_frame_1;
  return prepared;
}

PreparedJoints prepare(const std::array<double, kJointCount>& gains, const JointVector& joints) {
  PreparedJoints prepared{joints, {}};
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    prepared.turned[joint] = cos_sin(gains[joint] * joints[static_cast<Eigen::Index>(joint)]);
  }
  return prepared;
}

CosSin twice_a_turn(const CosSin& turned) {
  return {turned.cos * turned.cos - turned.sin * turned.sin, 2.0 * turned.cos * turned.sin};
}

std::array<CosSin, kJointCount> ripple_phases(const KinematicModel& model, const JointVector& joints) {
  std::array<CosSin, kJointCount> phases = kEvenJoints;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const double periods = model.ripple_periods_per_turn[joint];
    if (periods == 0.0 || model.joint_types[joint] == JointType::kPrismatic) continue;
    phases[joint] = cos_sin(periods * model.gains[joint] * joints[static_cast<Eigen::Index>(joint)]);
  }
  return phases;
}

Chain forward_chain(const PreparedModel& prepared, const PreparedJoints& joints) {
  Chain chain;
  compute_rigid_chain(prepared, joints, chain);
  chain.turned = joints.turned;
  chain.commanded = joints.joints;
  if (!prepared.is_compliant && !prepared.has_harmonics && !prepared.has_periods) return chain;
  JointVector moved = JointVector::Zero();
  if (prepared.is_compliant) {
    const Eigen::Map<const JointVector> compliance(prepared.model.compliance_rad_per_nm.data());
    moved = compliance.cwiseProduct(gravity_torques_nm(prepared, chain));
  }
  for (std::size_t joint = 0; prepared.has_harmonics && joint < kJointCount; ++joint) {
    if (prepared.model.joint_types[joint] == JointType::kPrismatic) continue;
    const CosSin& first = prepared.model.harmonics_rad[joint];
    const CosSin& second = prepared.model.second_harmonics_rad[joint];
    const CosSin& once = joints.turned[joint];
    const CosSin twice = twice_a_turn(once);
    moved[static_cast<Eigen::Index>(joint)] +=
        first.cos * once.cos + first.sin * once.sin + second.cos * twice.cos + second.sin * twice.sin;
  }
  if (prepared.has_periods) {
    const auto phases = ripple_phases(prepared.model, joints.joints);
    for (std::size_t joint = 0; joint < kJointCount; ++joint) {
      const CosSin& ripple = prepared.model.ripples_rad[joint];
      moved[static_cast<Eigen::Index>(joint)] +=
          ripple.cos * phases[joint].cos + ripple.sin * phases[joint].sin;
    }
  }
  compute_rigid_chain(prepared, prepare(prepared.model.gains, joints.joints + moved), chain);
  return chain;
}

Chain forward_chain(const PreparedModel& prepared, const JointVector& joints) {
  return forward_chain(prepared, prepare(prepared.model.gains, joints));
}

Chain forward_chain(const KinematicModel& model, const JointVector& joints) {
  return forward_chain(prepare(model), joints);
}

Eigen::Isometry3d forward_kinematics(const KinematicModel& model, const JointVector& joints) {
  return forward_chain(model, joints).block_from_frame.back();
}

Eigen::Matrix<double, 3, kJointCount> tip_jacobian(const KinematicModel& model, const Chain& chain) {
  return point_jacobian(model, chain, chain.tip_in_block_m());
}

Eigen::Matrix<double, 3, kJointCount> point_jacobian(const KinematicModel& model, const Chain& chain,
                                                     const Eigen::Vector3d& point_in_block_m) {
  Eigen::Matrix<double, 3, kJointCount> jacobian;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    const Eigen::Isometry3d& frame = chain.block_from_frame[index + 1];
    const Eigen::Vector3d axis = frame.linear().col(2);
    jacobian.col(joint) =
        model.gains[index] * (model.joint_types[index] == JointType::kRevolute
                                  ? axis.cross(point_in_block_m - frame.translation()).eval()
                                  : axis);
  }
  return jacobian;
}

}  // namespace calib
