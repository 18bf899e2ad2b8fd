#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/touch.hpp"
#include "calib_core/proof/calibration_record.hpp"
#include "calib_core/proof/proof_alternatives.hpp"
#include "calib_core/proof/touch_rows.hpp"

/// Whether a calibrated arm is right where it was not calibrated: touches of the same block at another place,
/// never fitted. The block's pose there is free, so that nothing needs to be measured but the touches.
namespace calib {

/// Six of them are taken by the block's pose.
inline constexpr int kProofTouchCount = 12;
inline constexpr int kProofTouchesMin = 9;

/// Nearer to the place of the calibration than this is no proof: there the calibrated arm was made right.
inline constexpr double kProofWayMinMetres = 0.1;

/// A ball farther from its face than this, at the pose that fits best, touched something else.
inline constexpr double kProofFarMetres = 2e-3;

/// Where and how the touches of a proof are made.
struct ProofPlace {
  /// About where the block stands, as planned or located: R_-1 there in R_-1 of the calibration.
  Eigen::Isometry3d calibrated_from_block = Eigen::Isometry3d::Identity();
  /// One standard deviation of the arm's growth since the calibration, a share of its lengths: what is not
  /// known of its warmth. A growth within it is no fault of the model. It is against the arm as it was in the
  /// middle of the calibration: a part of it, nobody knows how much, came while that was touched and bent its
  /// result. 0: exactly as warm, and as warm throughout the calibration.
  double std_growth = 0.0;
};

struct ProofLimits {
  double rms_max_m = 30e-6;  // "proof_rms_max_mm" of a cell's limits
  double p_min = 0.01;       // of the chi-square test
};

struct ProofVerdict {
  /// Of the distances against their covariance: noise as measured by the calibration and what it left open.
  double chi_square = 0.0;
  double degrees_of_freedom = 0.0;
  double p = 1.0;  // by F where the noise has few degrees of freedom
  /// Of the distances at the pose, and where it may differ the growth, of least squares, by their degrees of
  /// freedom.
  double rms_m = 0.0;
  Eigen::Isometry3d calibrated_from_block;  // where the block stood: R_-1 there in R_-1 of the calibration
  Eigen::VectorXd distances_m;              // of each touch from its face, at that pose
  bool passed = false;
  std::vector<std::string> reasons;  // why it did not; one sentence each
};

/// Why there is no verdict: one sentence with the remedy.
struct ProofRefusal {
  std::string message;
};

/// Refused: fewer than
/// kProofTouchesMin touches, numbers that are not finite, a face that does not exist, touches that do not
/// determine the block's pose, a touch kProofFarMetres from its face, a block that stands where it stood.
std::variant<ProofVerdict, ProofRefusal> prove(const CalibrationRecord& record, const ProofPlace& place,
                                               std::span<const Touch> touches,
                                               const ProofLimits& limits = {});

/// Of the distances of touches when nothing is wrong, square metres: noise as each touch's levers make it,
/// what the calibration left open, and growth with what it bent of the calibration.
Eigen::MatrixXd proof_covariance(const CalibrationRecord& record, const ProofPlace& place,
                                 const TouchRows& rows, std::span<const Touch> touches);

/// What these touches would see of an alternative.
struct ProofPower {
  std::string name;
  double noncentrality = 0.0;  // of the chi-square test, expected over the directions of the alternative
  double power = 0.0;          // the probability of p < p_min at that noncentrality
};
std::vector<ProofPower> proof_power(const CalibrationRecord& record,
                                    std::span<const ProofAlternative> alternatives, const ProofPlace& place,
                                    std::span<const Touch> touches, const ProofLimits& limits = {});

}  // namespace calib
