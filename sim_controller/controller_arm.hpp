#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/val3/program/values.hpp"

namespace sim {

/// The nominal arm as a CS8 knows it: its bare flange in `world`, which lies at the height of the shoulder.
/// SI; the arm file's frame 7, which the drives move, is the flange with the probe on it.
class ControllerArm {
 public:
  /// From the wrist's centre to the flange along frame 6: 100 mm on a TX90.
  explicit ControllerArm(const Plant& plant, double wrist_to_flange_m);

  [[nodiscard]] Eigen::Isometry3d world_from_flange(const calib::JointVector& joints) const;
  /// Within the joint ranges, in that configuration (kSame: as `near` is), each joint as near to `near` as
  /// whole turns allow; nothing when there is none.
  [[nodiscard]] std::optional<calib::JointVector> solve(const Eigen::Isometry3d& world_from_flange,
                                                        const val3::Config& config,
                                                        const calib::JointVector& near) const;
  /// The posture nearest to `near` that brings the flange there when no joint has a range; nothing when the
  /// pose is out of reach.
  [[nodiscard]] std::optional<calib::JointVector> posture_beyond_ranges(
      const Eigen::Isometry3d& world_from_flange, const calib::JointVector& near) const;
  /// Manual 6, pages 135 and 136.
  [[nodiscard]] val3::Config config_of(const calib::JointVector& joints) const;
  /// A millionth of a degree of rounding is no violation.
  [[nodiscard]] bool in_range(const calib::JointVector& joints) const;

  /// What the drives' planning wants: the flange in the nominal arm's frame 7, `world` in R_-1.
  [[nodiscard]] const Eigen::Isometry3d& tip_from_flange() const { return tip_from_flange_; }
  [[nodiscard]] const Eigen::Isometry3d& block_from_world() const { return block_from_world_; }

 private:
  [[nodiscard]] std::optional<calib::JointVector> nearest_turns(const calib::JointVector& joints,
                                                                const calib::JointVector& near) const;

  calib::KinematicModel model_;  // world to flange
  calib::JointRanges ranges_;    // widened by the rounding that is no violation
  calib::InverseKinematics inverse_;
  Eigen::Isometry3d tip_from_flange_;
  Eigen::Isometry3d block_from_world_;
};

/// The shoulder, elbow and wrist that a demand allows, seen from a posture (kSame) in that configuration.
bool is_allowed(const val3::Config& demanded, const val3::Config& start, const val3::Config& found);

}  // namespace sim
