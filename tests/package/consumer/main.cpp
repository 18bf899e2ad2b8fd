// Identifies a TX90 (paper, Tables I and II) from the touches document that is named and prints the errors,
// metres and radians.
#include <cstdio>
#include <fstream>
#include <numbers>

#include "calib_core/identification/identify.hpp"
#include "calib_core/kinematics/error_parameters.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  constexpr double kQuarter = std::numbers::pi / 2;
  calib::IdentificationProblem problem;
  problem.nominal.links = {{{.r_m = 0.1496},
                            {.alpha_rad = kQuarter, .d_m = -0.625, .r_m = 0.1208},
                            {.alpha_rad = -kQuarter, .d_m = 0.050, .theta_rad = -kQuarter},
                            {.d_m = 0.425, .theta_rad = kQuarter, .r_m = 0.050},
                            {.alpha_rad = kQuarter, .r_m = 0.425},
                            {.alpha_rad = -kQuarter},
                            {.alpha_rad = kQuarter},
                            {.theta_rad = -0.256, .r_m = 0.3189}}};
  problem.artefact = calib::exact_artefact(
      {{{0, 0, -1}, 0.075}, {{-1, 0, 0}, 0.075}, {{0, -1, 0}, 0.150}, {{0, 0, 1}, 0.075}});
  std::ifstream file(argv[1]);
  char separator{};
  for (std::string word; file >> word;) {
    if (word == "\"plane\":") file >> problem.touches.emplace_back().face;
    if (word != "\"joints_deg\":") continue;
    problem.touches.back().face -= 1;
    for (double& joint : problem.touches.back().joints) {
      file >> separator >> joint;
      joint *= std::numbers::pi / 180;
    }
  }
  calib::IdentificationOptions options;
  for (const char* name : {"r2", "alpha6", "d6", "theta6", "r6", "theta7"})
    options.identifiability.tried_last.push_back(calib::error_parameter_index(name).value());
  const calib::IdentificationResult result = calib::identify(problem, options);
  for (const int column : result.identifiable.columns)
    std::printf("%s %.12f\n", calib::error_parameters()[static_cast<std::size_t>(column)].name().c_str(),
                result.errors[column]);
  return result.status == calib::IdentificationStatus::kConverged ? 0 : 1;
}
