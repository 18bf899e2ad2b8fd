#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/error_parameters.hpp"
#include "calib_core/identifiability.hpp"
#include "calib_core/kinematic_model.hpp"
#include "calib_core/observation_matrix.hpp"
#include "calib_core/plane.hpp"
#include "calib_core/touch.hpp"

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

struct IdentificationProblem {
  KinematicModel nominal;
  std::vector<Plane>
      contact_planes;          // one a face: where the ball's centre is at the trigger; see contact_plane()
  std::vector<Touch> touches;  // those with role fit are fitted
};

enum class IdentificationStatus {
  kConverged,
  kNotConverged,   // iterations_max steps were not enough, or a step was not finite
  kTooFewTouches,  // fewer fitted touches than the parameters need
  kUnobservable,   // enough touches, but they show fewer parameters than the faces and the stylus could
  kBadInput,  // a joint that is not finite, a face that does not exist, eq. 6 on a face through the origin
};

/// One step of the iteration: W and the residual before it, the step's size (metres and radians) after it.
struct Iteration {
  double condition_number = 0.0;         // eq. 16, of the identifiable columns of W, metres and radians
  double scaled_condition_number = 0.0;  // after columns of unit norm
  double residual_rms_m = 0.0;
  double step_norm = 0.0;
};

/// Signed distances of one face's touches from its contact plane, nominal and calibrated model. Metres.
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
  int fitted_touch_count = 0;
  int attainable_count = 0;      // identifiable parameters that well-spread touches on all faces show
  IdentifiableSet identifiable;  // chosen on the nominal model, touches moved onto the nominal faces
  std::vector<double>
      singular_values;  // of W (all columns) at the nominal model, descending, the non-zero ones
  std::vector<Iteration> iterations;         // [0] is at the nominal model
  ErrorVector errors = ErrorVector::Zero();  // of the identified parameters; 0 elsewhere
  KinematicModel calibrated;                 // nominal with `errors`
  std::vector<FaceDistances> distances;      // a role and face that has touches
  std::optional<double>
      noise_estimated_m;  // residuals over the degrees of freedom; needs more touches than unknowns
};

/// Steps smaller than this end the iteration (metres and radians).
inline constexpr double kStepNormConverged = 1e-11;

/// The paper's method (section III): choose the identifiable parameters once on the nominal model, then solve
/// eq. 15 with scaled columns and update until the step vanishes. Starts from all touches every time.
IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options);

/// Identifiable parameters that touches well spread over all faces, reachable or not, would show.
IdentifiableSet attainable_parameters(const KinematicModel& nominal, const std::vector<Plane>& contact_planes,
                                      const IdentifiabilityOptions& options);

}  // namespace calib
