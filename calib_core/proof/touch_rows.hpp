#pragma once

#include <Eigen/Geometry>
#include <span>

#include "calib_core/geometry/touch.hpp"
#include "calib_core/proof/calibration_record.hpp"

namespace calib {

/// Touches that were not fitted, as the calibrated arm sees them from one place of the block. A row per
/// touch, metres.
struct TouchRows {
  Eigen::VectorXd distances_m;  // of the ball from where the estimate has the face
  Eigen::MatrixXd of_arm;       // d distance / d ArmVector
  Eigen::MatrixXd of_joints;    // d distance / d position of each joint, metres per radian
  Eigen::MatrixXd of_unknowns;  // d distance / d unknown of the record, but for the block's place
  /// d distance / d error that moves the whole arm against the block: of these columns, is_place_error().
  Eigen::MatrixXd of_place;
};

/// `arm`: the calibrated arm with the block where it stands now, in the block's frame. The touches' roles do
/// not matter.
TouchRows touch_rows(const CalibrationRecord& record, const KinematicModel& arm,
                     std::span<const Touch> touches);

/// d distance / d growth of the arm's lengths, by errors_by_growth(): metres per share. `of_arm`: as of
/// TouchRows.
Eigen::VectorXd growth_effect(const CalibrationRecord& record, const Eigen::MatrixXd& of_arm);

/// Of distances by a growth of the arm since the calibration of one standard deviation `std_growth` (a share
/// of its lengths) and by what it bent of that calibration, square metres. A row per touch, as of TouchRows.
Eigen::MatrixXd growth_covariance(const CalibrationRecord& record, double std_growth,
                                  const Eigen::MatrixXd& of_arm, const Eigen::MatrixXd& of_unknowns);

/// The calibrated arm in the frame of a block that was moved. `calibrated_from_block`: the block's frame R_-1
/// as it stands, in R_-1 of the calibration.
KinematicModel arm_at(const KinematicModel& calibrated, const Eigen::Isometry3d& calibrated_from_block);

}  // namespace calib
