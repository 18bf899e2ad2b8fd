#include "calib_core/numerics/distributions.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

namespace calib {
namespace {

/// In double, not long double: kDistributionErrorMax is met, and the file compiles and runs faster.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

void require(bool in_domain, const char* what) {
  if (!in_domain) throw std::domain_error(what);
}

}  // namespace

double chi_square_survival(double x, double degrees) {
  require(x >= 0.0, "chi_square_survival: x must not be negative");
  require(degrees > 0.0 && degrees <= kChiSquareDegreesMax, "chi_square_survival: degrees out of range");
  if (std::isinf(x)) return 0.0;
  return cdf(complement(boost::math::chi_squared_distribution<double, Policy>(degrees), x));
}

double chi_square_quantile(double probability, double degrees) {
  require(probability > 0.0 && probability < 1.0, "chi_square_quantile: probability out of range");
  require(degrees > 0.0 && degrees <= kChiSquareDegreesMax, "chi_square_quantile: degrees out of range");
  return quantile(boost::math::chi_squared_distribution<double, Policy>(degrees), probability);
}

double normal_two_sided_confidence(double factor) {
  require(factor >= 0.0, "normal_two_sided_confidence: the factor must not be negative");
  return 1.0 - 2.0 * cdf(complement(boost::math::normal_distribution<double, Policy>(), factor));
}

double normal_two_sided_factor(double confidence) {
  require(confidence > 0.0 && confidence < 1.0, "the confidence must lie between 0 and 1");
  return -quantile(boost::math::normal_distribution<double, Policy>(), (1.0 - confidence) / 2.0);
}

double student_two_sided_factor(double confidence, double degrees) {
  require(degrees >= 1.0, "student_two_sided_factor: degrees must be 1 or more");
  if (std::isinf(degrees)) return normal_two_sided_factor(confidence);
  require(confidence > 0.0 && confidence < 1.0, "the confidence must lie between 0 and 1");
  return -quantile(boost::math::students_t_distribution<double, Policy>(degrees), (1.0 - confidence) / 2.0);
}

double f_survival(double x, double numerator_degrees, double denominator_degrees) {
  require(x >= 0.0 && std::isfinite(x), "f_survival: x must be finite and not negative");
  require(numerator_degrees > 0.0 && denominator_degrees > 0.0 && std::isfinite(numerator_degrees) &&
              std::isfinite(denominator_degrees),
          "f_survival: degrees out of range");
  return cdf(complement(
      boost::math::fisher_f_distribution<double, Policy>(numerator_degrees, denominator_degrees), x));
}

double chi_square_power(double p_min, double degrees, double noncentrality) {
  require(noncentrality >= 0.0 && std::isfinite(noncentrality),
          "chi_square_power: noncentrality out of range");
  const double limit = chi_square_quantile(1.0 - p_min, degrees);
  if (noncentrality == 0.0) return p_min;
  return cdf(complement(
      boost::math::non_central_chi_squared_distribution<double, Policy>(degrees, noncentrality), limit));
}

double f_power(double p_min, double numerator_degrees, double denominator_degrees, double noncentrality) {
  require(noncentrality >= 0.0 && std::isfinite(noncentrality), "f_power: noncentrality out of range");
  require(p_min > 0.0 && p_min < 1.0, "f_power: level out of range");
  if (noncentrality == 0.0) return p_min;
  const double limit = quantile(complement(
      boost::math::fisher_f_distribution<double, Policy>(numerator_degrees, denominator_degrees), p_min));
  return cdf(complement(boost::math::non_central_f_distribution<double, Policy>(
                            numerator_degrees, denominator_degrees, noncentrality),
                        limit));
}

double sample_quantile(std::vector<double> values, double share) {
  require(!values.empty() && share > 0.0 && share <= 1.0, "sample_quantile: no values or share out of range");
  const auto no_number = std::ranges::find_if(values, [](double value) { return std::isnan(value); });
  if (no_number != values.end()) return *no_number;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto wanted = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::ranges::nth_element(values, wanted);
  return *wanted;
}

}  // namespace calib
