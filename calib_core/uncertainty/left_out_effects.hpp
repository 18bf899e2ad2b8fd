#pragma once

#include <Eigen/Core>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// How much of an effect that was left out of a fit may still be there.
namespace calib {

/// What the residuals of a fit without a group of n effects say of it: H^T (1 - hat) H and H^T residuals,
/// with rows and residuals in one unit and the columns of H times the declared standard deviations of the
/// effects.
struct GroupEvidence {
  Eigen::MatrixXd information;  // n x n
  Eigen::VectorXd score;        // n
};

/// `own`, `shared`: information of the touches on the group (n x n), and on the estimated parameters and the
/// group (m x n); `gradient`: their sum of rows times residuals (n); `std`: the declared deviations (n);
/// `covariance`: of the estimated parameters (m x m), the inverse of their information.
GroupEvidence evidence_of_group(const Eigen::MatrixXd& own, const Eigen::MatrixXd& shared,
                                const Eigen::VectorXd& gradient, const Eigen::VectorXd& std,
                                const Eigen::MatrixXd& covariance);

/// What the same fit says of the noise of a touch, in the squared unit of the group's evidence.
struct NoiseEvidence {
  double squares = 0.0;  // chi-square, the effects of the group in it
  double degrees = 0.0;  // of freedom of that
  /// The variance of a touch where the group leaves fewer degrees than kNoiseDegreesBesideMin.
  double otherwise = 1.0;
};
inline constexpr double kNoiseDegreesBesideMin = 10.0;  // fewer tell a variance too badly

/// A group of effects with standard deviations s times their declared ones, 0 <= s <= 4 and before the
/// touches the likelier the smaller (density exp(-decay s)): the mean of s^2 after them. The score has
/// covariance v information + s^2 information^2 with the variance v of a touch, which is judged beside the
/// group: effects that are in the residuals must not pass for noise, or they would hide themselves.
/// `expected_share`: the mean of s^2 without any touch, at most a quarter.
double mean_variance_share(const GroupEvidence& group, const NoiseEvidence& noise, double expected_share);

/// The direction in which each joint turns while the ball moves against `outward` with its orientation kept,
/// as in a search: +1 or -1; 0 in a posture where no joint speeds lead that way.
JointVector search_directions(const KinematicModel& model, const Chain& chain,
                              const Eigen::Vector3d& outward);

}  // namespace calib
