#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/estimation/goodness_of_fit.hpp"
#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/uncertainty/scale_check.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"

namespace calib {

/// Signed distances of the touches of one face from its contact plane, for the nominal and the calibrated
/// model. Metres. The plane is the nominal or the estimated one.
struct FaceDistances {
  int face = 0;
  TouchRole role = TouchRole::kFit;
  int touch_count = 0;
  double nominal_mean_m = 0.0;
  double nominal_rms_m = 0.0;
  double calibrated_mean_m = 0.0;
  double calibrated_rms_m = 0.0;
  /// One standard deviation of calibrated_mean_m, of touches that were not fitted; nothing without a noise.
  std::optional<double> calibrated_mean_std_m;
  /// Of a face that is estimated in place, when converged: how far outwards of the written plane it was
  /// found. The calibrated distances are from where it was found.
  std::optional<double> found_offset_m;
};

struct IdentificationResult {
  IdentificationStatus status = IdentificationStatus::kTooFewTouches;
  std::string message;  // one sentence, unless converged: what is wrong and what to do
  std::vector<std::string> warnings;
  int fitted_touch_count = 0;  // without the rejected ones
  Attainable attainable;
  IdentifiableSet identifiable;          // chosen on the nominal model, touches moved onto the nominal faces
  std::string rank_explanation;          // why not more parameters are identifiable
  std::vector<double> singular_values;   // non-zero ones of W (all columns) at the nominal model, descending
  std::vector<Iteration> iterations;     // [0] is at the nominal model
  ArmVector errors = ArmVector::Zero();  // of the estimated parameters; 0 elsewhere and unless converged
  /// Positions in nongeometric_parameters() of what was estimated beside the candidates.
  std::vector<int> nongeometric;
  std::string model_reason;         // why these, in a sentence; empty where there was no choice
  ResidualSum residual_sum;         // of the fitted touches, when converged
  double gear_variance_m2 = 0.0;    // of a fitted touch by the maker's figures of the gears
  double weight_noise_m = 0.0;      // the noise that weighed the touches against priors; 0 is unknown
  KinematicModel calibrated;        // nominal with `errors`
  Eigen::VectorXd artefact_errors;  // one per artefact parameter, SI units; empty unless converged
  std::vector<RejectedTouch> rejected;
  std::vector<FaceDistances> distances;          // one per role and face with touches
  std::optional<double> noise_estimated_m;       // from the residuals; needs more touches than unknowns
  std::optional<LackOfFit> lack_of_fit;          // needs a declared noise
  bool is_declared_noise_too_large = false;      // is_declared_too_large()
  std::optional<UncertaintyBudget> uncertainty;  // when converged
  std::optional<ScaleCheck> scale;               // when converged
};

}  // namespace calib
