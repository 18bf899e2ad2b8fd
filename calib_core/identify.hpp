#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/error_parameters.hpp"
#include "calib_core/kinematic_model.hpp"
#include "calib_core/plane.hpp"
#include "calib_core/touch.hpp"

namespace calib {

/// What a row of W is: the signed distance in metres, or eq. 6 of the paper, which divides it by the plane's
/// distance from the origin (and so has no form for a face through the origin).
enum class Formulation { kSignedDistance, kPlaneCoefficients };

struct IdentificationOptions {
  Formulation formulation = Formulation::kSignedDistance;
  std::optional<double> qr_tolerance;  // on |R_ii|; eq. 13 when absent
  std::vector<int> tried_last;         // candidates moved to the end of the column order, in this order
  std::vector<int> excluded;           // candidates never identified
  int iterations_max = 20;
};

struct IdentificationProblem {
  KinematicModel nominal;
  std::vector<Plane> contact_planes;  // one a face: where the ball's centre is at the trigger; see contact_plane()
  std::vector<Touch> touches;         // those with role fit are fitted
};

enum class ParameterStatus {
  kIdentified,
  kGrouped,   // its effect is carried by identified ones
  kNoEffect,  // a column of zeros
  kExcluded,  // by the options
  kWeak,      // independent, but under the given tolerance
};

/// One step of the iteration: W and the residual before it, the step's size after it.
struct Iteration {
  double condition_number = 0.0;         // eq. 16, of the identifiable columns of W, metres and radians
  double scaled_condition_number = 0.0;  // after columns of unit norm
  double residual_rms_m = 0.0;
  double step_norm = 0.0;
};

struct IdentifiedParameter {
  ParameterStatus status = ParameterStatus::kNoEffect;
  double error = 0.0;                                // metres or radians; 0 unless identified
  std::vector<std::pair<int, double>> grouped_with;  // (identified candidate, factor): what one unit of it adds there
};

enum class IdentificationStatus {
  kConverged,
  kNotConverged,    // iterations_max steps were not enough, or a step was not finite
  kTooFewTouches,   // fewer fitted touches than identifiable parameters
  kUnobservable,    // enough touches, but they show fewer parameters than the faces and the stylus could
  kBadInput,        // a joint that is not finite, a face that does not exist, eq. 6 on a face through the origin
};

/// Mean and rms of the signed distances of one face's touches, nominal and calibrated. Metres.
struct FaceDistances {
  int face = 0;
  int touch_count = 0;
  double nominal_mean_m = 0.0;
  double calibrated_mean_m = 0.0;
  double nominal_rms_m = 0.0;
  double calibrated_rms_m = 0.0;
};

struct IdentificationResult {
  IdentificationStatus status = IdentificationStatus::kTooFewTouches;
  std::string message;                          // what is missing, in one sentence, when not converged
  int fitted_touch_count = 0;
  int identifiable_count = 0;
  int attainable_count = 0;                     // what well-spread touches on all faces would show
  std::vector<double> singular_values;          // of W at the nominal model, all columns, descending; the non-zero ones
  std::vector<Iteration> iterations;            // [0] is at the nominal model
  std::array<IdentifiedParameter, kErrorParameterCount> parameters;
  ErrorVector errors = ErrorVector::Zero();     // of the identified ones, 0 elsewhere
  KinematicModel calibrated;                    // nominal with `errors`
  std::vector<FaceDistances> fit_distances;
  std::vector<FaceDistances> held_out_distances;
  double noise_estimated_m = 0.0;               // rms of the residuals over the degrees of freedom
};

IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options);

}  // namespace calib
