#pragma once

#include <Eigen/Core>

#include "calib_core/proof/calibration_record.hpp"
#include "calib_core/proof/touch_rows.hpp"

namespace calib {

/// How the distances of a check's touches change with what may change in a cell: a row per touch, metres per
/// radian, per metre and per share.
struct CheckEffects {
  Eigen::VectorXd of_growth;  // of the arm's lengths, by errors_by_growth()
  Eigen::MatrixXd of_joints;  // offsets, a column for each of kCheckedJoints
  Eigen::MatrixXd of_stylus;  // the errors of frame 7: a displaced ball
  Eigen::MatrixXd of_block;   // its pose, see TouchRows::of_place
};

/// `rows`: of the touches at the place of the calibration.
CheckEffects check_effects(const CalibrationRecord& record, const TouchRows& rows);

}  // namespace calib
