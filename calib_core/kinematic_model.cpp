#include "calib_core/kinematic_model.hpp"

#include <cmath>

namespace calib {

Eigen::Isometry3d frame_transform(const LinkParameters& link) {
  const double ca = std::cos(link.alpha_rad), sa = std::sin(link.alpha_rad);
  const double cb = std::cos(link.beta_rad), sb = std::sin(link.beta_rad);
  const double ct = std::cos(link.theta_rad), st = std::sin(link.theta_rad);

  // Rot(y,beta) Rot(x,alpha), column by column, then Rot(z,theta) mixes the first two.
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

Chain forward_chain(const KinematicModel& model, const JointVector& joints) {
  Chain chain;
  Eigen::Isometry3d block_from_previous = Eigen::Isometry3d::Identity();
  for (int frame = 0; frame < kFrameCount; ++frame) {
    LinkParameters link = model.links[static_cast<std::size_t>(frame)];
    const int joint = frame - 1;
    if (joint >= 0 && joint < kJointCount) {
      const auto index = static_cast<std::size_t>(joint);
      const double moved = model.gains[index] * joints[joint];
      (model.joint_types[index] == JointType::kRevolute ? link.theta_rad : link.r_m) += moved;
    }
    auto& here = chain.block_from_frame[static_cast<std::size_t>(frame)];
    here = block_from_previous * frame_transform(link);
    block_from_previous = here;
  }
  return chain;
}

Eigen::Isometry3d forward_kinematics(const KinematicModel& model, const JointVector& joints) {
  return forward_chain(model, joints).block_from_frame.back();
}

Eigen::Matrix<double, 3, kJointCount> tip_jacobian(const KinematicModel& model, const Chain& chain) {
  Eigen::Matrix<double, 3, kJointCount> jacobian;
  const Eigen::Vector3d tip = chain.tip_in_block_m();
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    const Eigen::Isometry3d& frame = chain.block_from_frame[index + 1];
    const Eigen::Vector3d axis = frame.linear().col(2);
    jacobian.col(joint) = model.gains[index] * (model.joint_types[index] == JointType::kRevolute
                                                    ? axis.cross(tip - frame.translation()).eval()
                                                    : axis);
  }
  return jacobian;
}

}  // namespace calib
