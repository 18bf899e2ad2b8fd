#pragma once

#include <Eigen/Core>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// How much of an effect that was left out of a fit may still be there.
namespace calib {

/// A group of effects with standard deviations s times their declared ones, 0 <= s <= 1 and before the
/// touches the likelier the smaller (density 2 - 2 s): the mean of s^2 after them. `information` (n x n) and
/// `score` (n) are what the residuals of a fit without the group say of it: H^T (1 - hat) H and H^T
/// residuals, with rows and residuals in one unit and the columns of H times their declared standard
/// deviations; `noise_variance` in that unit. The score has covariance noise_variance information + s^2
/// information^2. A sixth without any touch.
double mean_variance_share(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                           double noise_variance);

/// The direction in which each joint turns while the ball moves against `outward` with its orientation kept,
/// as in a search: +1 or -1; 0 in a posture where no joint speeds lead that way.
JointVector search_directions(const KinematicModel& model, const Chain& chain,
                              const Eigen::Vector3d& outward);

}  // namespace calib
