#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// The fit to the half of the rows that agree best: solution, and which rows those are.
struct TrimmedFit {
  Eigen::VectorXd solution;
  std::vector<bool> core;
};

/// Least trimmed squares of rows * x = targets by random starts and concentration steps (Rousseeuw and Van
/// Driessen, Computing LTS regression for large data sets, 2006). Half of the rows less the unknowns may be
/// wrong. `precision` is that of a wide prior around 0: the touches of three planes alone are fitted without
/// any residual by an arm that has shrunk to a point in their corner. Nothing when there are hardly more rows
/// than unknowns.
std::optional<TrimmedFit> least_trimmed_squares(const Eigen::MatrixXd& rows, const Eigen::VectorXd& targets,
                                                const Eigen::VectorXd& precision, std::mt19937_64& chance);

/// One chance in so many good data sets that a good touch is called bad.
inline constexpr double kFalseAlarmsPerSet = 0.002;

/// Scatter under this is not told from the resolution of what the joints are given with.
inline constexpr double kScatterMinMetres = 1e-7;

/// Residuals over what noise and fit leave them, after solve(): a kept touch takes part of its own error up,
/// a touch left out has the fit's error added. In units of the declared noise.
Eigen::VectorXd studentized(LeastSquares& fit);

/// How large one of `count` studentized residuals of good touches may be; degrees of the noise, or infinite.
double largest_expected(int count, double degrees_of_freedom);

}  // namespace calib
