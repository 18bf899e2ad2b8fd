#include "tests/calib_core/paper.hpp"

#include <map>
#include <numbers>
#include <string>

namespace calib::paper {

KinematicModel nominal() {
  constexpr double kQuarter = std::numbers::pi / 2;
  KinematicModel model;
  model.links = {{{.r_m = 0.1496},
                  {.alpha_rad = kQuarter, .d_m = -0.625, .r_m = 0.1208},
                  {.alpha_rad = -kQuarter, .d_m = 0.050, .theta_rad = -kQuarter},
                  {.d_m = 0.425, .theta_rad = kQuarter, .r_m = 0.050},
                  {.alpha_rad = kQuarter, .r_m = 0.425},
                  {.alpha_rad = -kQuarter},
                  {.alpha_rad = kQuarter},
                  {.theta_rad = -0.256, .r_m = 0.3189}}};
  return model;
}

ErrorVector table3() {
  const std::map<std::string, double> values{
      {"theta0", 0.0050}, {"r0", -8.3836e-3},  {"alpha1", -0.0046}, {"d1", -0.8920e-3},  {"theta1", 0.0083},
      {"r1", -0.9588e-3}, {"alpha2", -0.0012}, {"d2", 0.9559e-3},   {"theta2", -0.0017}, {"alpha3", 0.0004},
      {"d3", 3.2636e-3},  {"theta3", 0.0044},  {"r3", 0.6675e-3},   {"beta3", 0.0006},   {"d4", -2.2895e-3},
      {"theta4", 0.0027}, {"r4", 3.1939e-3},   {"d5", -1.1318e-3},  {"theta5", -0.0036}, {"r5", -0.4481e-3},
      {"alpha7", 0.0027}, {"d7", -1.3547e-3},  {"r7", 3.7510e-3}};
  ErrorVector errors = ErrorVector::Zero();
  for (const auto& [name, value] : values) errors[error_parameter_index(name).value()] = value;
  return errors;
}

std::vector<ContactSurface> planes() {
  return {{{0, 0, -1}, 0.075}, {{-1, 0, 0}, 0.075}, {{0, -1, 0}, 0.150}, {{0, 0, 1}, 0.075}};
}

std::vector<int> tried_last() {
  std::vector<int> indices;
  for (const char* name : {"r2", "alpha6", "d6", "theta6", "r6", "theta7"}) {
    indices.push_back(error_parameter_index(name).value());
  }
  return indices;
}

}  // namespace calib::paper
