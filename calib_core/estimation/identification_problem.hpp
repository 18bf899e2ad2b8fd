#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/estimation/pure_error.hpp"
#include "calib_core/estimation/repeat_sources.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/observability/identifiability.hpp"
#include "calib_core/observability/observation_matrix.hpp"

namespace calib {

/// Scaling of the columns of W for the solution of eq. 15. kUnitNorm: the weighted pseudo-inverse of the
/// paper. kUnits: metres and radians.
enum class ColumnScaling { kUnitNorm, kUnits };

/// What becomes of the first harmonic of each joint's transmission. kWhenShown: estimated when the touches
/// show it (identification/model_selection.hpp).
enum class Harmonics { kLeaveOut, kWhenShown, kEstimate };

/// What becomes of the ripple of each gear at its known period: likewise.
enum class Ripple { kLeaveOut, kWhenShown };

struct IdentificationOptions {
  Formulation formulation = Formulation::kSignedDistance;
  IdentifiabilityOptions identifiability;
  ColumnScaling weights = ColumnScaling::kUnitNorm;
  bool robust = true;      // find touches that are inconsistent with the others, and leave them out
  bool prior = false;      // maximum a posteriori with the maker's tolerances, without a choice of columns
  bool stiffness = false;  // estimate the compliance of joints 1 to 3 where it has a prior
  Harmonics harmonics = Harmonics::kLeaveOut;
  Ripple ripple = Ripple::kLeaveOut;
  /// Exactly these of nongeometric_parameters(), positions in ascending order, in place of what the last
  /// three would choose.
  std::optional<std::vector<int>> nongeometric = std::nullopt;
  bool hold_weak = true;      // keep parameters at nominal that the declared noise would make meaningless
  bool measure_noise = true;  // correct the declared noise by the residuals; else it is taken as it is
  int iterations_max = 20;
};

/// How many kinematic parameters well-distributed touches on all faces would determine, with the given tip
/// and with the tip moved off the axis of the last joint.
struct Attainable {
  int count = 0;
  int off_axis_count = 0;
};

struct IdentificationProblem {
  KinematicModel nominal;
  Artefact artefact;
  std::vector<Touch> touches;  // those with role kFit are fitted
  /// Declared standard deviation along the normal; 0 is unknown. Of the touches without one of their own.
  double touch_noise_m = 0.0;
  /// From what was touched more than once; the declared noise is a prior for it.
  std::optional<TouchNoise> pure_error;
  /// The same where it is too small to be noise (is_implausibly_small()): it is not used, and warned of.
  std::optional<TouchNoise> doubted_error;
  /// What that is made of. Only told, never counted a second time.
  RepeatSources repeat_sources;
  ErrorTolerances
      tolerances{};  // the maker's: the prior, and the size of errors that touches do not determine
  /// The maker's figures for what the arm does beside rigid kinematics: the prior where it is estimated, a
  /// source of uncertainty where it is not.
  NongeometricDeviations nongeometric_std{};
  /// One standard deviation of each joint's position error that changes from posture to posture (ripple, play
  /// and stops of the drives); radians.
  JointVector gear_std_rad = JointVector::Zero();
  /// One standard deviation of how far each joint lags behind its drive in the direction of its motion, the
  /// same in every touch: half the play of the gears; radians. In gear_std_rad as well, which is for motions
  /// of any direction.
  JointVector gear_lag_std_rad = JointVector::Zero();
  /// One standard deviation of a joint's stop by the maker's figures, radians; in gear_std_rad as well. The
  /// least that touches scatter follows from it.
  JointVector stop_std_rad = JointVector::Zero();
  /// How far one place seemed to move against the arm while the touches were made (warming, a block that
  /// moves): the result is of the middle of that, and afterwards the tip is off by up to half of it.
  double drift_m = 0.0;
  /// Of that, whether it is shown or not: what the scatter of the place's touches leaves open.
  TouchNoise drift_uncertainty;
  /// Depends on arm, faces and options only. Set it when many identifications share these; else each call
  /// computes it.
  std::optional<Attainable> attainable;
  /// A previous choice of columns, to be kept (validation B.1 and B.2); `start` is the arm it led to.
  std::optional<std::vector<int>> columns;
  ArmVector start = ArmVector::Zero();
};

/// Changes the noise of all touches: a touch with a deviation of its own keeps its weight against the others.
inline void assume_noise(IdentificationProblem& problem, double noise_m) {
  const double ratio = problem.touch_noise_m > 0.0 ? noise_m / problem.touch_noise_m : 1.0;
  problem.touch_noise_m = noise_m;
  for (Touch& touch : problem.touches) touch.deviation_m *= ratio;
}

enum class IdentificationStatus {
  kConverged,
  kNotConverged,      // iterations_max steps were not enough, or a step was not finite
  kTooFewTouches,     // fewer fitted touches than parameters
  kOneFace,           // all touches are on one face
  kOnePosture,        // all touches have the same posture
  kUnobservable,      // enough touches, but they determine fewer parameters than faces and stylus allow
  kFarTouch,          // a touch far from every face, or from its own face when no touch may be left out
  kContradictory,     // too many touches are inconsistent with the others
  kCoincidingPlanes,  // two faces lie in one plane: the touched one is ambiguous
  kSingularPrior,     // a tolerance of 0, or no tolerance where the touches determine nothing either
  kBadInput,  // a number that is not finite, a face that does not exist, eq. 6 on a face through the origin
};

/// One iteration: W and the residuals before its step, the size of the step (metres and radians). The row of
/// a touch with a deviation of its own counts as much less as it is less certain: noise_factor().
struct Iteration {
  double condition_number = 0.0;         // eq. 16, of the identifiable columns of W, metres and radians
  double scaled_condition_number = 0.0;  // of the same columns scaled to unit norm
  double residual_rms_m = 0.0;
  double step_norm = 0.0;
};

enum class RejectionReason { kOutlier, kWrongFace };

struct RejectedTouch {
  std::size_t touch = 0;  // index into the touches of the problem
  double residual_m = 0.0;
  RejectionReason reason = RejectionReason::kOutlier;
};

/// A smaller step ends the iteration (metres and radians).
inline constexpr double kStepNormConverged = 1e-11;

/// A touch that is farther than kFarOffMetres from its plane was made on another face if one is within
/// kOnOtherPlaneMetres; otherwise it is not a touch of this block.
inline constexpr double kFarOffMetres = 0.050;
inline constexpr double kOnOtherPlaneMetres = 0.025;

}  // namespace calib
