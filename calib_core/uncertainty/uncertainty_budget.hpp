#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "calib_core/kinematics/error_parameters.hpp"

namespace calib {

/// Chi-square of the residuals against the declared noise: whole and face by face (a face without touches has
/// p = 1). A small p says that the model does not describe what was touched.
struct LackOfFit {
  double chi_square = 0.0;
  double degrees_of_freedom = 0.0;
  double p = 1.0;
  std::vector<double> p_of_face;
};

/// Below this p the declared noise is not believed: the estimated one takes its place in all uncertainties.
inline constexpr double kLackOfFitWidens = 0.05;

/// One cause of uncertainty and what it alone makes of the errors' covariance.
struct UncertaintySource {
  std::string name;  // "touch_noise", "block_size", "squareness", "stylus_radius", ...
  ArmMatrix covariance = ArmMatrix::Zero();
};

struct Correlation {
  int first = 0, second = 0;  // indices into ArmVector
  double coefficient = 0.0;
};

/// How sure the identified errors are. Covariances are of true less identified errors, metres and radians. An
/// identified error stands for a combination (itself and what is grouped into it): `identified` is of that
/// combination. An error that was excluded or held is there all the same, within the maker's tolerances, and
/// falsifies the others: `held`. What is grouped or without effect is unknown within them too: `unseen`.
struct Certainty {
  double noise_m = 0.0;             // of a touch, as used: declared, or estimated when it is not believed
  double degrees_of_freedom = 0.0;  // of that noise; infinite when declared
  double coverage_factor = 0.0;     // 95 %, Student
  ArmMatrix identified = ArmMatrix::Zero();
  ArmMatrix held = ArmMatrix::Zero();
  ArmMatrix unseen = ArmMatrix::Zero();
  std::vector<int> unseen_without_tolerance;  // unseen errors of which nobody says how large they may be
  Eigen::Matrix<double, kArmParameterCount, Eigen::Dynamic> unknown_directions;  // one a member of that list
  std::vector<UncertaintySource> sources;                                        // they add up to all three
  Eigen::VectorXd artefact_std;
  std::vector<Correlation> correlations;  // the strongest, strongest first

  /// All of it: what a prediction at any pose and for any tool needs.
  [[nodiscard]] ArmMatrix covariance() const { return identified + held + unseen; }
  /// One standard deviation of an identified error (or compliance), by its index in ArmVector.
  [[nodiscard]] double std_error(int index) const {
    return std::sqrt(identified(index, index) + held(index, index));
  }
};

}  // namespace calib
