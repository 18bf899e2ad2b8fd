#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/observability/identifiability.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/uncertainty/scale_check.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"

namespace calib {

/// Weighting of the columns of W when eq. 15 is solved: unit norm (the paper's weighted pseudo-inverse), or
/// metres and radians as they are.
enum class ColumnScaling { kUnitNorm, kUnits };

struct IdentificationOptions {
  Formulation formulation = Formulation::kSignedDistance;
  IdentifiabilityOptions identifiability;
  ColumnScaling weights = ColumnScaling::kUnitNorm;
  bool robust = true;      // name touches that do not belong to the others, and leave them out
  bool prior = false;      // maximum a posteriori with the maker's tolerances, no choice of columns
  bool stiffness = false;  // estimate the compliance of joints 2 and 3, with its prior
  bool hold_weak = true;   // keep at nominal what the declared noise would make a guess
  int iterations_max = 20;
};

/// How many kinematic parameters touches well spread over all faces would show, and how many with the tip
/// moved off the last joint's axis.
struct Attainable {
  int count = 0;
  int off_axis_count = 0;
};

struct IdentificationProblem {
  KinematicModel nominal;
  Artefact artefact;
  std::vector<Touch> touches;    // those with role fit are fitted
  double touch_noise_m = 0.0;    // one standard deviation along the normal, as declared; 0 is unknown
  ErrorTolerances tolerances{};  // the maker's; the prior, and what the unseen errors may be
  std::array<std::optional<double>, kComplianceCount> std_compliance_rad_per_nm{};
  /// Depends on arm, faces and options only: computed once by who identifies often; else at each call.
  std::optional<Attainable> attainable;
  /// A choice made before, with the arm it led to (validation B.1 and B.2): kept instead of choosing anew.
  std::optional<std::vector<int>> columns;
  ArmVector start = ArmVector::Zero();
};

enum class IdentificationStatus {
  kConverged,
  kNotConverged,      // iterations_max steps were not enough, or a step was not finite
  kTooFewTouches,     // fewer fitted touches than the parameters need
  kOnePlane,          // all touches on one plane
  kOnePosture,        // one posture again and again
  kUnobservable,      // enough touches, but they show fewer parameters than the faces and the stylus could
  kFarTouch,          // a touch far off every plane, or off its own when nothing may be left out
  kContradictory,     // too many touches do not fit the others
  kCoincidingPlanes,  // two faces are one plane: which of them was touched cannot be told
  kSingularPrior,     // a tolerance of 0, or none where the touches show nothing either
  kBadInput,  // a number that is not finite, a face that does not exist, eq. 6 on a face through the origin
};

/// One step of the iteration: W and the residual before it, the step's size (metres and radians) after it.
struct Iteration {
  double condition_number = 0.0;         // eq. 16, of the identifiable columns of W, metres and radians
  double scaled_condition_number = 0.0;  // after columns of unit norm
  double residual_rms_m = 0.0;
  double step_norm = 0.0;
};

enum class RejectionReason { kOutlier, kWrongPlane };

struct RejectedTouch {
  std::size_t touch = 0;  // index into the problem's touches
  double residual_m = 0.0;
  RejectionReason reason = RejectionReason::kOutlier;
};

/// Signed distances of one face's touches from its contact plane, nominal and calibrated model. Metres. The
/// plane is the one written down, or the estimated one.
struct FaceDistances {
  int face = 0;
  TouchRole role = TouchRole::kFit;
  int touch_count = 0;
  double nominal_mean_m = 0.0;
  double nominal_rms_m = 0.0;
  double calibrated_mean_m = 0.0;
  double calibrated_rms_m = 0.0;
};

struct IdentificationResult {
  IdentificationStatus status = IdentificationStatus::kTooFewTouches;
  std::string message;  // what is missing and what to do, one sentence, unless converged
  std::vector<std::string> warnings;
  int fitted_touch_count = 0;  // those rejected not counted
  Attainable attainable;
  IdentifiableSet identifiable;  // chosen on the nominal model, touches moved onto the nominal faces
  std::string rank_explanation;  // why not more is seen
  std::vector<double>
      singular_values;  // of W (all columns) at the nominal model, descending, the non-zero ones
  std::vector<Iteration> iterations;     // [0] is at the nominal model
  ArmVector errors = ArmVector::Zero();  // of what was estimated; 0 elsewhere and unless converged
  KinematicModel calibrated;             // nominal with `errors`
  Eigen::VectorXd artefact_errors;       // one an artefact parameter, SI; empty unless converged
  std::vector<RejectedTouch> rejected;
  std::vector<FaceDistances> distances;  // a role and face that has touches
  std::optional<double>
      noise_estimated_m;  // residuals over the degrees of freedom; needs more touches than unknowns
  std::optional<LackOfFit> lack_of_fit;  // against the declared noise
  std::optional<Certainty> certainty;    // when converged
  std::optional<ScaleCheck> scale;       // when converged
};

/// Steps smaller than this end the iteration (metres and radians).
inline constexpr double kStepNormConverged = 1e-11;

/// A touch farther off its plane than the first is on the wrong plane if another one is nearer than the
/// second, and no touch of this block otherwise.
inline constexpr double kFarOffMetres = 0.050;
inline constexpr double kOnOtherPlaneMetres = 0.025;

/// The paper's method (section III): choose the identifiable parameters once on the nominal model, then solve
/// eq. 15 and update until the step vanishes; artefact parameters are estimated along with their priors. With
/// `robust`, touches that do not fit the others are named and left out (least trimmed squares for the start,
/// then a significance test). Starts from all touches every time; nothing random but a fixed sequence.
IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options);

}  // namespace calib
