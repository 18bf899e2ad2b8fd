#include "config/arm_uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "config/config_error.hpp"

namespace cell {
namespace {

using calib::kArmParameterCount;

/// Square metres, square radians, or of what the error's own unit is: an error that is certain is not listed.
constexpr NumberRange kVariances{.min = 1e-40, .max = 1e12};
constexpr NumberRange kCovariances{.min = -1e12, .max = 1e12};

/// Nine digits leave 5e-9 of each correlation open, and what is under 0 sums it up over all of them.
constexpr double kCorrelationRounding = 1e-6;

const std::vector<std::string>& arm_error_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int i = 0; i < kArmParameterCount; ++i) all.push_back(calib::arm_parameter_name(i));
    return all;
  }();
  return names;
}

std::vector<int> errors_from_json(const JsonValue& value) {
  std::vector<int> errors;
  for (const JsonValue& item : value.items(0, kArmParameterCount)) {
    const std::string name = item.text();
    const auto found = std::ranges::find(arm_error_names(), name);
    if (found == arm_error_names().end())
      item.fail("is " + in_quotes(name) + ", which no arm has; export the arm again");
    const auto index = static_cast<int>(found - arm_error_names().begin());
    if (!errors.empty() && index <= errors.back())
      item.fail("stands after " + in_quotes(calib::arm_parameter_name(errors.back())) +
                "; errors stand in the order of the result, each once; export the arm again");
    errors.push_back(index);
  }
  return errors;
}

/// Whether some sum of the errors would have a variance under 0.
bool has_negative_variance(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlations = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlations, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() < -kCorrelationRounding;
}

/// The number that nine digits say: an uncertainty is not known better, and a file is half as long.
double to_nine_digits(double value) {
  if (!std::isfinite(value)) throw std::logic_error("a covariance that is not finite is written");
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return std::strtod(text.data(), nullptr);
}

}  // namespace

calib::ArmCovariance arm_covariance_from_json(const JsonValue& value) {
  const JsonObject object = value.object({"errors", "covariance_si"});
  const std::vector<int> errors = errors_from_json(object.at("errors"));
  const JsonValue rows_value = object.at("covariance_si");
  const auto rows = rows_value.items(errors.size(), errors.size());
  calib::ArmCovariance covariance = calib::no_covariance();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto entries = rows[row].items(row + 1, row + 1);
    for (std::size_t column = 0; column <= row; ++column) {
      const double entry = entries[column].number(column == row ? kVariances : kCovariances);
      covariance(errors[row], errors[column]) = covariance(errors[column], errors[row]) = entry;
    }
  }
  const Eigen::MatrixXd given = covariance(errors, errors);
  if (!errors.empty() && has_negative_variance(given))
    rows_value.fail("is no covariance, a sum of these errors has a variance under 0; export the arm again");
  return covariance;
}

std::string arm_covariance_text(const calib::ArmCovariance& covariance) {
  nlohmann::json names = nlohmann::json::array();
  std::vector<int> errors;
  for (int i = 0; i < kArmParameterCount; ++i) {
    if (covariance(i, i) < kVariances.min) continue;
    errors.push_back(i);
    names.push_back(calib::arm_parameter_name(i));
  }
  std::string text = "{\n    \"errors\": " + names.dump() + ",\n    \"covariance_si\": [";
  for (std::size_t row = 0; row < errors.size(); ++row) {
    nlohmann::json entries = nlohmann::json::array();
    for (std::size_t column = 0; column <= row; ++column)
      entries.push_back(to_nine_digits(covariance(errors[row], errors[column])));
    text += (row == 0 ? "\n      " : ",\n      ") + entries.dump();
  }
  return text + "\n    ]\n  }";
}

}  // namespace cell
