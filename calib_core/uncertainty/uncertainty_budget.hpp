#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "calib_core/kinematics/error_parameters.hpp"

namespace calib {

/// A matrix of as many rows and columns as ArmMatrix that is cheap to move: a result holds many.
using ArmCovariance = Eigen::MatrixXd;
inline ArmCovariance no_covariance() { return ArmCovariance::Zero(kArmParameterCount, kArmParameterCount); }

/// One source of uncertainty and its contribution to the covariance of the errors.
struct UncertaintySource {
  std::string name;  // "touch_noise", "block_size", "squareness", "stylus_radius", ...
  ArmCovariance covariance = no_covariance();
};

struct Correlation {
  int first = 0, second = 0;  // indices into ArmVector
  double coefficient = 0.0;
};

/// Of the maker's variance of the harmonics of the joints that were left out: what the residuals leave.
struct HarmonicShares {
  double first = 0.0, second = 0.0;
};

/// Uncertainty of the identified errors. Covariances are those of true minus identified errors, metres and
/// radians. An identified error is a combination of itself and the parameters grouped with it; `identified`
/// is the covariance of that combination. A parameter that was excluded or held at nominal still has an error
/// within the maker's tolerance, which biases the others; so has what is beside rigid kinematics and was not
/// estimated: `held`. Grouped parameters and those without effect are also unknown within their tolerances:
/// `unseen`. `of_posture` are errors of the joints that change from posture to posture, and the drift.
struct UncertaintyBudget {
  double noise_m = 0.0;                      // of a touch, measured; the declared one is a prior for it
  double degrees_of_freedom = 0.0;           // of that noise
  ArmCovariance of_noise = no_covariance();  // the share of `identified` that the noise of the touches has
  ArmCovariance identified = no_covariance();
  ArmCovariance held = no_covariance();
  ArmCovariance unseen = no_covariance();
  ArmCovariance of_posture = no_covariance();
  /// The share of `of_posture` that a drift has which the scatter of the reference touches may hide, and the
  /// degrees of freedom of that scatter (0: there is no such share).
  ArmCovariance of_drift = no_covariance();
  double drift_degrees_of_freedom = 0.0;
  HarmonicShares harmonic_shares;
  /// Of the maker's variance of what changes from posture to posture: what the touches say of it.
  double gear_share = 1.0;
  std::vector<int> unseen_without_tolerance;  // unseen errors without a tolerance
  Eigen::Matrix<double, kArmParameterCount, Eigen::Dynamic>
      unknown_directions;  // one per member of that list
  /// What was not estimated and has a standard deviation: by one of them each displaces true minus estimated
  /// arm and artefact (rows: ArmVector, then the artefact parameters). `held` and `unseen` are made of them.
  Eigen::MatrixXd left_out;
  /// The same by one standard deviation of what displaces the touches by a pattern, a column each of
  /// touch_patterns(); in `held` as well.
  Eigen::MatrixXd patterned;
  std::vector<UncertaintySource> sources;  // their sum is that of the four above
  /// One standard deviation of each estimated artefact parameter, of all the above; NaN for a face that is
  /// estimated in place and is displaced by an unseen error without tolerance.
  Eigen::VectorXd artefact_std;
  std::vector<Correlation> correlations;  // the strongest ones in descending order

  /// 95 % coverage factor of a quantity with this variance, of which `noise_variance` is of the noise of the
  /// touches and `drift_variance` of `of_drift`: Student with the effective degrees of freedom of Welch and
  /// Satterthwaite (GUM, equation G.2b), all other sources being known exactly.
  [[nodiscard]] double coverage_factor_of(double variance, double noise_variance,
                                          double drift_variance = 0.0) const;
  /// The total covariance, for predictions at any pose and with any tool.
  [[nodiscard]] ArmMatrix covariance() const { return identified + held + unseen + of_posture; }
  /// Standard deviation of an estimated error by its index in ArmVector.
  [[nodiscard]] double std_error(int index) const {
    return std::sqrt(identified(index, index) + held(index, index));
  }
};

/// The budget of the arm in its own frame, for whoever works in the controller's world: the block's place
/// (is_place_error()) is nominal in the true and in the calibrated arm, so its errors have no effect. Their
/// rows and columns are zero in the first three covariances and in `unknown_directions`; how they correlate
/// with the arm's errors does not matter any more, the other rows and columns stay as they are. The joints'
/// own errors of posture remain, those of joint 1 included, and so does the drift, which may be the arm's.
/// Without the sources, the artefact and the correlations.
UncertaintyBudget in_arm_frame(const UncertaintyBudget& budget);

}  // namespace calib
