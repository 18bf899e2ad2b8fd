#include "service/run/verdict.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace cell {

using calib::mm_from_metres;

namespace {

using Reasons = std::vector<std::string>;

// Every comparison is written so that NaN misses its limit.

void judge_fit(const calib::IdentificationResult& result, const AcceptanceLimits& limits, Reasons& reasons) {
  if (!result.iterations.empty() &&
      !(result.iterations.back().condition_number <= limits.condition_number_max)) {
    reasons.push_back(fmt::format("the condition number is {:.0f}, the limit {:.0f}",
                                  result.iterations.back().condition_number, limits.condition_number_max));
  }
  for (std::size_t face = 0; result.lack_of_fit && face < result.lack_of_fit->p_of_face.size(); ++face) {
    // One plane of several is unlikely by chance that much more often.
    const double p = result.lack_of_fit->p_of_face[face];
    const auto faces = static_cast<double>(result.lack_of_fit->p_of_face.size());
    if (p * faces >= limits.lack_of_fit_p_min) continue;
    reasons.push_back(
        fmt::format("lack of fit on plane {}: its residuals exceed the declared touch noise (p = {:.1g}); "
                    "check this face",
                    face + 1, p));
  }
  if (result.lack_of_fit && !(result.lack_of_fit->p >= limits.lack_of_fit_p_min)) {
    reasons.push_back(
        fmt::format("lack of fit: the residuals exceed the declared touch noise (they show {:.1f} um; p = "
                    "{:.1g}, the limit is "
                    "{:g}): an effect is missing in the model",
                    1e3 * mm_from_metres(result.noise_estimated_m.value_or(0.0)), result.lack_of_fit->p,
                    limits.lack_of_fit_p_min));
  }
}

void judge_rejected(const calib::IdentificationResult& result, Reasons& reasons) {
  const auto rejected = static_cast<int>(result.rejected.size());
  const int touches = result.fitted_touch_count + rejected;
  if (rejected > kRejectedShareMax * touches) {
    reasons.push_back(fmt::format("{} of {} touches were rejected, more than {:.0f} %", rejected, touches,
                                  100.0 * kRejectedShareMax));
  }
}

void judge_set(const calib::IdentificationResult& result, const calib::IdentificationOptions& options,
               Reasons& reasons) {
  std::string held;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (result.identifiable.candidates[index].status != calib::ParameterStatus::kWeak ||
        is_estimated(options, result.identifiable, i))
      continue;
    held += (held.empty() ? "" : ", ") + calib::error_parameters()[index].name();
  }
  const auto shown = static_cast<int>(result.identifiable.columns.size());
  if (options.prior && shown < result.attainable.count) {
    reasons.push_back(
        fmt::format("incomplete set: the touches show {} of {} parameters, the prior gives the rest", shown,
                    result.attainable.count));
    return;
  }
  if (!held.empty()) reasons.push_back("incomplete set: these touches barely determine " + held);
}

void judge_tip(std::optional<double> tip_box_rms_m, const AcceptanceLimits& limits, Reasons& reasons) {
  if (!limits.tip_box_rms_max_m) return;
  const double limit_mm = mm_from_metres(*limits.tip_box_rms_max_m);
  if (!tip_box_rms_m) {
    reasons.push_back(fmt::format(
        "the tip's uncertainty in the workspace box is unknown, the limit is {:.3f} mm", limit_mm));
  } else if (!(*tip_box_rms_m <= *limits.tip_box_rms_max_m)) {
    reasons.push_back(
        fmt::format("the predicted tip uncertainty in the workspace box is {:.3f} mm, the limit is "
                    "{:.3f} mm",
                    mm_from_metres(*tip_box_rms_m), limit_mm));
  }
}

void judge_held_out(const calib::IdentificationResult& result, const AcceptanceLimits& limits,
                    Reasons& reasons) {
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role != calib::TouchRole::kHeldOut) continue;
    if (!(std::abs(face.calibrated_mean_m) <= limits.held_out_mean_max_m)) {
      reasons.push_back(fmt::format(
          "held-out touches on plane {} are off by {:.3f} mm in the mean, the limit is {:.3f} mm",
          face.face + 1, mm_from_metres(face.calibrated_mean_m), mm_from_metres(limits.held_out_mean_max_m)));
    }
    if (!(face.calibrated_rms_m <= limits.held_out_rms_max_m)) {
      reasons.push_back(fmt::format(
          "held-out touches on plane {} scatter by {:.3f} mm rms, the limit is {:.3f} mm", face.face + 1,
          mm_from_metres(face.calibrated_rms_m), mm_from_metres(limits.held_out_rms_max_m)));
    }
  }
}

}  // namespace

bool is_estimated(const calib::IdentificationOptions& options, const calib::IdentifiableSet& identifiable,
                  int index) {
  const calib::ParameterStatus status = identifiable.candidates[static_cast<std::size_t>(index)].status;
  return options.prior ? status != calib::ParameterStatus::kExcluded
                       : status == calib::ParameterStatus::kIdentified;
}

Judgement judge(const calib::IdentificationResult& result, const calib::IdentificationOptions& options,
                const AcceptanceLimits& limits, std::optional<double> tip_box_rms_m, bool complete) {
  Reasons reasons;
  if (!complete) reasons.emplace_back("the run was not completed");
  if (result.status != calib::IdentificationStatus::kConverged) {
    reasons.push_back(result.message);
  } else {
    judge_tip(tip_box_rms_m, limits, reasons);
  }
  if (result.scale && !result.scale->warning.empty()) reasons.push_back(result.scale->warning);
  judge_fit(result, limits, reasons);
  judge_rejected(result, reasons);
  judge_set(result, options, reasons);
  judge_held_out(result, limits, reasons);
  return {reasons.empty(), std::move(reasons)};
}

}  // namespace cell
