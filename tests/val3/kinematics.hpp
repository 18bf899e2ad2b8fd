#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "calib_core/kinematics/kinematic_model.hpp"
#include "sim_controller/val3/program/values.hpp"

namespace val3 {

/// The nominal arm as a CS8 knows it: bare flange in `world`, which lies at the height of the shoulder.
class NominalArm {
 public:
  /// The maker's TX90 of config/arms.
  NominalArm();

  [[nodiscard]] Eigen::Isometry3d world_from_flange(const Joint& joints_deg) const;
  /// Near `start_deg`; nothing when out of reach or singular. Ranges are not looked at.
  [[nodiscard]] std::optional<Joint> solve(const Eigen::Isometry3d& world_from_flange,
                                           const Joint& start_deg) const;
  [[nodiscard]] bool in_range(const Joint& joints_deg) const;
  [[nodiscard]] const Joint& speeds_deg_s() const { return speeds_deg_s_; }

 private:
  calib::KinematicModel model_;
  calib::JointRanges ranges_;
  Joint speeds_deg_s_{};
};

}  // namespace val3
