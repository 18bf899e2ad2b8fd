#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// The fit to the half of the rows that agrees best, and which rows those are.
struct TrimmedFit {
  Eigen::VectorXd solution;
  std::vector<bool> core;
};

/// Least trimmed squares of rows * x = targets by random starts and concentration steps (Rousseeuw and Van
/// Driessen, Computing LTS regression for large data sets, 2006). Up to half of the rows minus the unknowns
/// may be outliers. `precision` is that of a wide prior around 0. It is needed because an arm that has shrunk
/// to a point in the corner of three planes fits any touches of these without residuals. Nothing when there
/// are too few rows.
std::optional<TrimmedFit> least_trimmed_squares(const Eigen::MatrixXd& rows, const Eigen::VectorXd& targets,
                                                const Eigen::VectorXd& precision, std::mt19937_64& chance);

/// Probability that a data set without outliers has at least one touch rejected.
inline constexpr double kFalseAlarmsPerSet = 0.002;

/// Smaller scatter cannot be distinguished from the resolution of the joint positions.
inline constexpr double kScatterMinMetres = 1e-7;

/// Residuals after solve(), divided by the standard deviation that noise and fit give them: a kept touch
/// absorbs part of its own error, for a rejected one the error of the fit is added. Unit: the declared noise,
/// for a touch with a deviation of its own that one.
Eigen::VectorXd studentized_residuals(LeastSquares& fit);

/// Significance limit of the largest of `count` studentized residuals; degrees of freedom of the noise, or
/// infinite.
double studentized_residual_max(int count, double degrees_of_freedom);

}  // namespace calib
