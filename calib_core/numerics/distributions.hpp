#pragma once

#include <vector>

namespace calib {

/// Bound on the relative error of the functions below, wherever they answer; confidences from 1e-3 on.
inline constexpr double kDistributionErrorMax = 1e-10;

/// More degrees of freedom than this chi_square_survival does not take.
inline constexpr double kChiSquareDegreesMax = 1e5;

/// P(X > x) of a chi-square variable; x >= 0 or infinite, degrees in (0, kChiSquareDegreesMax]. Right in the
/// far tail too (1e-100). Outside the domain: std::logic_error, as in all functions here.
double chi_square_survival(double x, double degrees);

/// x with P(X <= x) = probability of a chi-square variable; probability in (0, 1), degrees as above.
double chi_square_quantile(double probability, double degrees);

/// P(|z| <= k) for a standard normal variable; k >= 0.
double normal_two_sided_confidence(double factor);

/// k with P(|z| <= k) = confidence for a standard normal variable; confidence in (0, 1).
double normal_two_sided_factor(double confidence);

/// k with P(|t| <= k) = confidence for Student's t: the coverage factor of the GUM, annex G. Degrees of
/// freedom from 1 on, not only whole ones; infinite ones mean the normal distribution.
double student_two_sided_factor(double confidence, double degrees);

/// P(X > x) of Fisher's F; x >= 0, degrees over 0 and finite.
double f_survival(double x, double numerator_degrees, double denominator_degrees);

/// The probability that a chi-square test at level `p_min` (in (0, 1)) alarms when the sum has this
/// noncentrality; 0 and more, finite.
double chi_square_power(double p_min, double degrees, double noncentrality);

/// The same of an F test whose numerator has the noncentrality.
double f_power(double p_min, double numerator_degrees, double denominator_degrees, double noncentrality);

/// The smallest of the values that at least this share of them does not exceed; the share in (0, 1], at least
/// one value. NaN when one of the values is.
double sample_quantile(std::vector<double> values, double share);

}  // namespace calib
