#include "calib_core/kinematics/gravity.hpp"

namespace calib {

JointVector gravity_torques_nm(const KinematicModel& model, const Chain& chain) {
  JointVector torques_nm = JointVector::Zero();
  const Eigen::Vector3d free_fall = kFreeFall * (chain.block_from_frame[1].linear() * model.down_in_frame_1);
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

}  // namespace calib
