#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "calib_core/estimation/estimate.hpp"
#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"

namespace calib {

class LeastSquares;

/// Smallest standoff of a touch that is computed with the online estimate.
inline constexpr double kAimedStandoffMinMetres = 0.005;
/// Lower bound of every predicted position error: gravity, temperature and backlash are not modelled here.
inline constexpr double kPredictedPositionErrorMinMetres = 0.001;

/// Comparison of a contact with its prediction, along the normal of the face.
struct PredictedContact {
  double position_error_m = 0.0;  // of the ball by the estimate before this contact; positive outside
  double predicted_position_error_m = 0.0;  // 3 sigma
  bool contradicts = false;  // inconsistent with the other touches: ignored until it agrees with them
};

/// Estimate of the arm during a run, updated with every touch. A value type.
///
/// The maximum a posteriori estimate of every error (theta0 to beta7, the compliance of each joint where
/// a prior is given) and every artefact parameter, linearised anew at each touch. The prior of an error is
/// its tolerance, but at least what the nominal position error allows: a length nominal_position_error / 6,
/// an angle nominal_position_error / 6 per metre, the block pose nominal_position_error / 2 and
/// nominal_position_error / 2 over 0.6 m; likewise for offset and tilts of a face that is estimated in place.
/// A touch has at least a noise of 0.1 mm, which covers unmodelled gravity, ripple and backlash.
class OnlineArmEstimate {
 public:
  /// Starts without touches, from the nominal arm, knowledge, nominal position error and bodies of `problem`.
  explicit OnlineArmEstimate(const PlanningProblem& problem);

  /// Adds a contact of any role. It is ignored when it is more than 5 standard deviations off the prediction
  /// of the others; of several such touches the worst is removed first.
  PredictedContact add(const Touch& touch);
  /// Puts a touch that was made again in the place of the first one, by its index. False when the others
  /// contradict it as well: it is ignored.
  bool replace(std::size_t index, const Touch& touch);

  [[nodiscard]] std::size_t touch_count() const { return knowledge_.touches.size(); }
  /// Indices of the touches that are ignored now, in the order in which they were added.
  [[nodiscard]] std::vector<std::size_t> contradicted() const;
  /// The nominal arm with the estimated errors.
  [[nodiscard]] const KinematicModel& model() const { return model_; }

  /// 3 sigma of the ball position at these joints in the worst direction, from the covariance of all errors;
  /// more when recent touches exceeded their prediction. Between kPredictedPositionErrorMinMetres and the
  /// nominal position error, for which the nominal arm itself is good enough.
  [[nodiscard]] double predicted_position_error_m(const JointVector& joints) const;

  /// The problem for a move or touch through these postures: `nominal` is the estimate, the nominal position
  /// error the largest predicted one; bodies with a larger predicted error have the difference as margin.
  /// Nothing when the nominal arm is as accurate, and nothing in a cell with a face that is estimated in
  /// place, as the position of its solid is not known well enough.
  [[nodiscard]] std::optional<PlanningProblem> aimed_problem(const PlanningProblem& problem,
                                                             std::span<const JointVector> postures) const;

  /// Estimated displacement of a face's contact plane from its nominal one at a point, along the outward
  /// normal. Exceeds the uncertainty of the face only when it is estimated in place.
  [[nodiscard]] double face_shift_m(int face, const Eigen::Vector3d& point_m) const;

 private:
  std::vector<bool> settle(LeastSquares& fit);
  void solve(LeastSquares& fit);
  bool reject_worst(LeastSquares& fit);
  void readmit(const LeastSquares& fit);
  /// The predicted error of a body's axis in a posture of model().
  [[nodiscard]] double predicted_position_error_m(const PreparedModel& prepared, const Chain& chain,
                                                  const Capsule& body) const;
  [[nodiscard]] double inflation() const;

  IdentificationProblem knowledge_;  // with the touches and the wide tolerances
  std::vector<int> columns_;         // indices into ArmVector
  double nominal_position_error_m_ = 0.0;
  std::vector<bool> kept_;                   // one per touch
  std::vector<double> standardised_errors_;  // one per touch: position error over its standard deviation
  Estimate estimate_;
  KinematicModel model_;
  Eigen::MatrixXd covariance_;  // of the unknowns: columns_, then the artefact parameters
};

/// The predicted position error of each touch when it is made in this order; that of the first is the nominal
/// one. Uses covariances only: no touch needs to have been made.
std::vector<double> predicted_position_errors_m(const PlanningProblem& problem,
                                                std::span<const PlannedTouch> touches);

}  // namespace calib
