#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/identification/identification_result.hpp"

/// Propagation of distributions through the whole identification: JCGM 101:2008, Supplement 1 to the GUM. It
/// needs no linearisation, and so it checks the linear uncertainty.
namespace calib {

class UniformChance;

/// Where the error of the tip is looked at.
struct MonteCarloPostures {
  std::vector<JointVector> box;
  std::vector<JointVector> joint_ranges;
};

/// One simulated calibration: the distances between the true tip and the calibrated one, in R_-1.
struct MonteCarloDraw {
  bool converged = false;
  double box_mean_square_m2 = 0.0;  // over the postures; 0 without any, as the next one
  double joint_ranges_mean_square_m2 = 0.0;
  double tip_error_m = 0.0;  // at one posture of the box: each draw takes the next
};

/// Simulated repetitions of a converged identification. A draw takes what UncertaintyBudget counts from
/// normal distributions of its standard deviations:
/// - the fitted arm and artefact are the true ones, and everything that was given about them with a standard
///   deviation (block, ball, pre-travel, temperature, certified lengths, compliances) is given anew with an
///   error;
/// - what was not estimated (held, without effect, grouped, masses, a compliance, harmonics) is off by its
///   tolerance in the true arm and nominal in the fit; without a known tolerance it stays nominal;
/// - each joint has a second harmonic that the residuals leave it, in the touches and at the tip;
/// - each joint lags behind its drive by as much in every touch, and the pre-travel of a push from the side
/// is
///   off by what is not known of it;
/// - the true arm touches the true faces at the fitted postures with the noise of a touch that the budget
///   uses, and the arm is identified from them: the same columns and weights, no search for outliers, no
///   choice of a model, Gauss-Newton to its end;
/// - at the postures where the tip is looked at each joint is off by its errors of posture (gears).
class MonteCarlo {
 public:
  /// `result` must be that of identify() for problem and options: converged, with an uncertainty. `fitted`
  /// are the touches it was fitted to, indices. Copies what it needs.
  MonteCarlo(const IdentificationProblem& problem, const IdentificationOptions& options,
             const IdentificationResult& result, std::span<const std::size_t> fitted,
             MonteCarloPostures postures);

  /// The simulated calibration of this number. The same number gives the same figures, at any time and from
  /// any thread: several threads may draw from one object.
  [[nodiscard]] MonteCarloDraw draw(std::uint64_t number) const;

  /// The linear prediction over the same postures, root mean square; nothing without any.
  [[nodiscard]] std::optional<double> linear_box_rms_m() const { return linear_box_rms_m_; }

 private:
  struct Truth {
    ArmVector arm;                                         // errors against the nominal arm
    Eigen::VectorXd artefact;                              // errors against the nominal artefact
    JointVector lag_rad;                                   // of each joint behind its drive
    Eigen::Vector3d sideways_m = Eigen::Vector3d::Zero();  // error of the pre-travel, by sideways_shapes()
    Eigen::Vector3d drifted_m = Eigen::Vector3d::Zero();   // of the tip, by the drift of the run
  };
  [[nodiscard]] Truth draw_truth(UniformChance& chance) const;
  [[nodiscard]] IdentificationProblem draw_problem(const Truth& truth, UniformChance& chance) const;
  /// A set of postures with the joints' own errors at each of them.
  struct Region {
    std::vector<PreparedJoints> postures;
    Eigen::MatrixX3d by_joint;  // d tip / d joint, transposed: six rows a posture
  };
  [[nodiscard]] std::vector<double> tip_errors_m(const Region& region, const Truth& truth,
                                                 const PreparedModel& true_arm,
                                                 const PreparedModel& calibrated,
                                                 UniformChance& chance) const;

  IdentificationProblem problem_;  // with the fitted touches alone
  IdentificationOptions options_;
  std::vector<int> columns_;  // estimated, indices into ArmVector
  ArmVector fitted_arm_;      // errors
  Eigen::VectorXd fitted_artefact_;
  Eigen::VectorXd prior_std_;  // of the columns, then of the artefact parameters; 0 where there is no prior
  std::vector<std::pair<int, double>> not_estimated_;  // index into ArmVector, standard deviation
  double noise_m_ = 0.0;
  std::vector<JointVector> joints_per_metre_;   // of each touch, along the outward normal
  std::vector<JointVector> search_directions_;  // of each touch
  Eigen::MatrixX3d sideways_shapes_;            // of each touch, a row
  Region box_, joint_ranges_;
  std::optional<double> linear_box_rms_m_;
};

/// What draws tell together.
struct MonteCarloFigures {
  int count = 0;
  int converged = 0;
  std::optional<double> box_rms_m;  // over the converged draws and the postures
  std::optional<double> box_p95_m;  // 95 % of the tip errors in the box are at most this
  std::optional<double> joint_ranges_rms_m;
  std::optional<double> linear_over_monte_carlo;  // of the rms in the box, same postures
  std::string warning;  // the linear figure is off, or draws did not converge; else empty
};

/// The linear prediction is warned of when it differs from the Monte Carlo by more than this share, and by
/// more than kMonteCarloSigmas standard deviations of what so few draws can tell.
inline constexpr double kLinearShareMax = 0.10;
inline constexpr double kMonteCarloSigmas = 3.0;

/// `draws` are numbers 0, 1, 2, ... of one MonteCarlo. No figures unless two of them have converged.
MonteCarloFigures figures_of(std::span<const MonteCarloDraw> draws, std::optional<double> linear_box_rms_m);

}  // namespace calib
