#include "calib_core/kinematics/gravity.hpp"

#include <algorithm>

namespace calib {
namespace {

/// Weight of one kilogram in the block's frame R_-1.
Eigen::Vector3d weight_per_kg(const PreparedModel& prepared, const Chain& chain) {
  return kFreeFall * (chain.block_from_frame[0].linear() * prepared.down_in_frame_0);
}

}  // namespace

JointVector gravity_torques_nm(const PreparedModel& prepared, const Chain& chain) {
  JointVector torques_nm = JointVector::Zero();
  const KinematicModel& model = prepared.model;
  const Eigen::Vector3d free_fall = weight_per_kg(prepared, chain);
  double mass_kg = 0.0;
  Eigen::Vector3d first_moment_kg_m = Eigen::Vector3d::Zero();
  for (std::size_t frame = kFrameCount - 1; frame > 0; --frame) {
    const PointMass& here = model.masses[frame];
    const Eigen::Isometry3d& block_from_here = chain.block_from_frame[frame];
    mass_kg += here.mass_kg;
    first_moment_kg_m += here.mass_kg * (block_from_here * here.center_in_frame_m);
    const std::size_t joint = frame - 1;
    if (joint >= kJointCount || model.joint_types[joint] == JointType::kPrismatic) continue;
    const Eigen::Vector3d about_joint_kg_m = first_moment_kg_m - mass_kg * block_from_here.translation();
    torques_nm[static_cast<Eigen::Index>(joint)] =
        model.gains[joint] * block_from_here.linear().col(2).dot(about_joint_kg_m.cross(free_fall));
  }
  return torques_nm;
}

JointVector gravity_torques_nm(const KinematicModel& model, const Chain& chain) {
  return gravity_torques_nm(prepare(model), chain);
}

Eigen::Matrix<double, kJointCount, kMassCount> gravity_torques_of_masses_nm(const PreparedModel& prepared,
                                                                            const Chain& chain) {
  Eigen::Matrix<double, kJointCount, kMassCount> torques_nm =
      Eigen::Matrix<double, kJointCount, kMassCount>::Zero();
  const Eigen::Vector3d free_fall = weight_per_kg(prepared, chain);
  for (int frame = 1; frame < kFrameCount; ++frame) {
    const PointMass& mass = prepared.model.masses[static_cast<std::size_t>(frame)];
    if (mass.mass_kg == 0.0) continue;
    const Eigen::Vector3d center_m =
        chain.block_from_frame[static_cast<std::size_t>(frame)] * mass.center_in_frame_m;
    for (int joint = 0; joint < std::min(frame, kJointCount); ++joint) {
      const auto index = static_cast<std::size_t>(joint);
      if (prepared.model.joint_types[index] == JointType::kPrismatic) continue;
      const Eigen::Isometry3d& own = chain.block_from_frame[index + 1];
      torques_nm(joint, frame - 1) = prepared.model.gains[index] * mass.mass_kg *
                                     own.linear().col(2).dot((center_m - own.translation()).cross(free_fall));
    }
  }
  return torques_nm;
}

}  // namespace calib
