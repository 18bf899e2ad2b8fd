#include "calib_core/numerics/distributions.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/SpecialFunctions>

namespace calib {
namespace {

/// From here on the expansion about the normal distribution is the more exact of the two ways (its first term
/// left out is below 5e-12 for a tail of 1e-12).
constexpr double kExpandedFromDegrees = 1e4;

void require(bool in_domain, const char* what) {
  if (!in_domain) throw std::domain_error(what);
}

/// P(|t| > k), k > 0: Abramowitz and Stegun 26.7.1 with 26.5.27.
double student_tail(double k, double degrees) {
  const double sum = degrees + k * k;
  // A small k would vanish beside the degrees in the first form; a far tail beside 1 in the second.
  return k > 1.0 ? Eigen::numext::betainc(degrees / 2.0, 0.5, degrees / sum)
                 : 1.0 - Eigen::numext::betainc(0.5, degrees / 2.0, k * k / sum);
}

double student_density(double k, double degrees) {
  const double log_constant = Eigen::numext::lgamma((degrees + 1.0) / 2.0) -
                              Eigen::numext::lgamma(degrees / 2.0) -
                              0.5 * std::log(degrees * std::numbers::pi);
  return std::exp(log_constant - 0.5 * (degrees + 1.0) * std::log1p(k * k / degrees));
}

/// Abramowitz and Stegun 26.7.5, its first four terms.
double expanded_about_normal(double z, double degrees) {
  const double z2 = z * z;
  const double g1 = (z2 + 1.0) * z / 4.0;
  const double g2 = ((5.0 * z2 + 16.0) * z2 + 3.0) * z / 96.0;
  const double g3 = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) * z / 384.0;
  return z + (g1 + (g2 + g3 / degrees) / degrees) / degrees;
}

}  // namespace

double chi_square_survival(double x, double degrees) {
  require(x >= 0.0, "chi_square_survival: x must not be negative");
  require(degrees > 0.0 && degrees <= kChiSquareDegreesMax, "chi_square_survival: degrees out of range");
  return Eigen::numext::igammac(degrees / 2.0, x / 2.0);
}

double normal_two_sided_factor(double confidence) {
  require(confidence > 0.0 && confidence < 1.0, "the confidence must lie between 0 and 1");
  return -Eigen::numext::ndtri((1.0 - confidence) / 2.0);
}

double student_two_sided_factor(double confidence, double degrees) {
  require(degrees >= 1.0, "student_two_sided_factor: degrees must be 1 or more");
  double k = normal_two_sided_factor(confidence);
  if (degrees >= kExpandedFromDegrees) return expanded_about_normal(k, degrees);

  // The logarithm of the tail is a concave, falling function of log k: Newton's steps on it overshoot once at
  // most, upwards, and then come down to the root.
  constexpr int kStepsMax = 50;
  constexpr double kRelativeStep = 1e-13;
  for (int i = 0; i < kStepsMax; ++i) {
    const double tail = student_tail(k, degrees);
    const double log_excess = std::log(tail / (1.0 - confidence));
    const double step = log_excess * tail / (2.0 * k * student_density(k, degrees));
    k *= std::exp(step);
    if (std::abs(step) < kRelativeStep) break;
  }
  return k;
}

}  // namespace calib
