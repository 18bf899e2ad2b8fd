#include "calib_core/identification/result_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace calib {
namespace {

/// Fewer touches of one face may be outliers each for itself.
constexpr int kLostTouchesMin = 3;

void warn_of_weak(IdentificationResult& result) {
  std::string names;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const auto& candidate = result.identifiable.candidates[static_cast<std::size_t>(i)];
    if (candidate.status != ParameterStatus::kWeak) continue;
    names += (names.empty() ? "" : ", ") + error_parameters()[static_cast<std::size_t>(i)].name();
  }
  if (names.empty()) return;
  result.warnings.push_back("held at nominal because these touches hardly show it: " + names +
                            "; spread the touches over more postures and tilts");
}

/// Masses without the deviation of a compliance: the droop is neither in the model nor in an uncertainty.
void warn_of_droop(const IdentificationProblem& problem, IdentificationResult& result) {
  const auto has_mass = [](const PointMass& mass) { return mass.mass_kg > 0.0; };
  if (std::ranges::none_of(problem.nominal.masses, has_mass)) return;
  if (!estimable_compliances(problem.nongeometric_std).empty()) return;
  result.warnings.emplace_back(
      "the arm has masses but no standard deviation of a compliance of joints 1 to 3, so that its droop is "
      "in no uncertainty; add std_compliance_rad_per_nm to \"gravity\" in the arm's file");
}

/// Below 0 by this many standard deviations a compliance is not within its uncertainty any more.
constexpr double kNegativeSigmas = 3.0;

/// Gravity pulls every joint downwards: one that gives way upwards has gravity or a mass the wrong way round.
void warn_of_negative_compliance(IdentificationResult& result) {
  for (const int position : result.nongeometric) {
    const NongeometricParameter& parameter = nongeometric_parameters()[static_cast<std::size_t>(position)];
    if (parameter.kind != NongeometricKind::kCompliance || !result.uncertainty) continue;
    const double value =
        result.calibrated.compliance_rad_per_nm[static_cast<std::size_t>(parameter.number - 1)];
    const double sigmas = -value / result.uncertainty->std_error(nongeometric_index(position));
    if (!(sigmas > kNegativeSigmas)) continue;
    result.warnings.push_back(
        "joint " + std::to_string(parameter.number) +
        " would give way upwards: its compliance is below 0 by " + std::to_string(std::lround(sigmas)) +
        " standard deviations. Check \"down_in_frame_1\" and the masses under \"gravity\" in the arm's file "
        "against how the arm is mounted");
  }
}

/// A droop that was left out and that the touches show.
void warn_of_shown_droop(IdentificationResult& result) {
  if (!result.lack_of_fit || !result.lack_of_fit->droop) return;
  const DroopTest& droop = *result.lack_of_fit->droop;
  if (droop.p >= kDroopShownP) return;
  std::ostringstream figures;
  figures.precision(2);
  figures << "F " << droop.f << ", p " << droop.p;
  result.warnings.push_back(
      "the residuals look like a droop of the joints, which is not in the model (" + figures.str() +
      "), so that the tip's uncertainty may be too small; estimate it (identify --stiffness on, or "
      "\"stiffness\":\"auto\" in the recipe)");
}

/// Beyond it a workshop's temperature is unusual.
constexpr double kUsualFrom20C = 10.0;

/// Nothing but the given figure says how warm the block is: all lengths follow it, and the residuals stay.
void warn_of_temperature(const IdentificationProblem& problem, IdentificationResult& result) {
  const auto& all = problem.artefact.parameters;
  const auto given = std::ranges::find(all, ArtefactKind::kTemperature, &ArtefactParameter::kind);
  if (given == all.end() || std::abs(given->nominal - 20.0) <= kUsualFrom20C) return;
  result.warnings.push_back(
      "the block was given as " + std::to_string(std::lround(given->nominal)) +
      " degrees C, far from the 20 of its certificate: all lengths of the arm are scaled "
      "by it and no touch shows a wrong figure; check the block's temperature");
}

/// A face whose touches were all left out as outliers: the others agree with another place of it.
void warn_of_lost_faces(const IdentificationProblem& problem, IdentificationResult& result) {
  for (std::size_t face = 0; face < problem.artefact.contact_planes.size(); ++face) {
    int kept = 0, lost = 0;
    double off_m = 0.0;
    for (std::size_t i = 0; i < problem.touches.size(); ++i) {
      const Touch& touch = problem.touches[i];
      if (touch.role != TouchRole::kFit || static_cast<std::size_t>(touch.face) != face) continue;
      const auto rejected = std::ranges::find(result.rejected, i, &RejectedTouch::touch);
      rejected == result.rejected.end() ? ++kept : ++lost;
      if (rejected != result.rejected.end()) off_m += rejected->residual_m;
    }
    if (kept > 0 || lost < kLostTouchesMin) continue;
    std::ostringstream millimetres;
    millimetres.precision(3);
    millimetres << std::fixed << 1e3 * off_m / lost;
    result.warnings.push_back(
        "all " + std::to_string(lost) + " touches of plane " + std::to_string(face + 1) +
        " were left out: they are " + millimetres.str() +
        " mm in the mean from where the other planes want it. Check its offset_mm and the lengths in the "
        "block's file, and stylus_radius_mm and pretravel_mm in the probe's file, of which an error counts "
        "twice between opposite planes");
  }
}

void warn_of_drift(const IdentificationProblem& problem, IdentificationResult& result) {
  if (problem.drift_m == 0.0) return;
  result.warnings.push_back(
      "the reference place moved by " + std::to_string(std::lround(1e6 * problem.drift_m)) +
      " um while the touches were made: the arm was still warming up, or block or probe moved. The result is "
      "of the middle of that, and half of it is in the uncertainty; warm the arm up longer and calibrate "
      "again");
}

void warn_of_declared_noise(const IdentificationProblem& problem, IdentificationResult& result) {
  if (!result.is_declared_noise_too_large || !result.uncertainty) return;
  const auto micrometres = [](double metres) { return std::to_string(std::lround(1e6 * metres)) + " um"; };
  result.warnings.push_back(
      "the declared noise of a touch, " + micrometres(problem.touch_noise_m) +
      ", is too large: the residuals show " + micrometres(*result.noise_estimated_m) +
      ", which chance makes of it in less than 1 of 1,000 runs; " + micrometres(result.uncertainty->noise_m) +
      " were used. Write \"touch_noise_mm\" in the cell's file as small as the touches are");
}

void warn_of_doubted_repeats(const IdentificationProblem& problem, IdentificationResult& result) {
  if (!problem.doubted_error) return;
  const auto micrometres = [](double metres) {
    std::ostringstream text;
    text.precision(2);
    text << std::fixed << 1e6 * metres << " um";
    return text.str();
  };
  const auto readings = std::lround(problem.doubted_error->degrees_of_freedom) + 2;
  result.warnings.push_back("the " + std::to_string(readings) +
                            " touches of the reference place scatter by " +
                            micrometres(problem.doubted_error->std_m) +
                            " only, less than any probe on an arm: they are of another plane, or were not "
                            "made one by one. They say " +
                            (problem.pure_error ? std::string("nothing of the noise")
                                                : "nothing of the noise, for which the declared " +
                                                      micrometres(problem.touch_noise_m) + " stand") +
                            "; check plane and joints of \"reference_touches\"");
}

}  // namespace

void add_warnings(const IdentificationProblem& problem, const IdentificationOptions& options,
                  IdentificationResult& result) {
  if (!options.prior) warn_of_weak(result);
  if (result.status == IdentificationStatus::kConverged) {
    warn_of_droop(problem, result);
    warn_of_negative_compliance(result);
    if (options.measure_noise) warn_of_declared_noise(problem, result);
    warn_of_drift(problem, result);
    warn_of_doubted_repeats(problem, result);
    warn_of_shown_droop(result);
    warn_of_temperature(problem, result);
    warn_of_lost_faces(problem, result);
  }
  if (result.scale && !result.scale->warning.empty()) result.warnings.push_back(result.scale->warning);
}

}  // namespace calib
