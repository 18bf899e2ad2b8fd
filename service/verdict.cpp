#include "service/verdict.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "calib_core/units.hpp"

namespace cell {

using calib::mm_from_metres;

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNone:
      return "none";
    case Verdict::kAccepted:
      return "accepted";
    case Verdict::kRejected:
      return "rejected";
    case Verdict::kIncomplete:
      return "incomplete";
  }
  return "";
}

Judgement judge(const calib::IdentificationResult& result, const AcceptanceLimits& limits, bool complete) {
  std::vector<std::string> reasons;
  if (!complete) reasons.emplace_back("the run did not come to its end");
  if (result.status != calib::IdentificationStatus::kConverged) reasons.push_back(result.message);
  // Written so that a figure that is no number misses its limit.
  if (!result.iterations.empty() &&
      !(result.iterations.back().condition_number <= limits.condition_number_max)) {
    reasons.push_back(fmt::format("the condition number is {:.0f}, the limit {:.0f}",
                                  result.iterations.back().condition_number, limits.condition_number_max));
  }
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
  return {reasons.empty(), std::move(reasons)};
}

}  // namespace cell
