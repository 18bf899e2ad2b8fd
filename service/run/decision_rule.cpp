#include "service/run/decision_rule.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace cell {

using calib::mm_from_metres;

namespace {

/// Standard deviation of one touch, as in the uncertainties of the result.
double noise_m(const calib::IdentificationResult& result, const Cell& cell) {
  return result.uncertainty ? result.uncertainty->noise_m : cell.touch_noise_m;
}

void add_held_out(const calib::FaceDistances& face, double noise, const Cell& cell,
                  std::vector<Criterion>& list) {
  const double n = face.touch_count;
  const double std_face_m =
      cell.block.face_uncertainties.at(static_cast<std::size_t>(face.face)).std_offset_m;
  list.push_back({.name = "held_out_mean",
                  .plane = face.face + 1,
                  .unit = "mm",
                  .value = mm_from_metres(std::abs(face.calibrated_mean_m)),
                  .limit = mm_from_metres(cell.acceptance.held_out_mean_max_m),
                  .expanded_uncertainty =
                      kCoverageFactor * mm_from_metres(std::hypot(noise / std::sqrt(n), std_face_m))});
  list.push_back({.name = "held_out_rms",
                  .plane = face.face + 1,
                  .unit = "mm",
                  .value = mm_from_metres(face.calibrated_rms_m),
                  .limit = mm_from_metres(cell.acceptance.held_out_rms_max_m),
                  .expanded_uncertainty = kCoverageFactor * mm_from_metres(noise / std::sqrt(2.0 * n))});
}

}  // namespace

bool Criterion::within_limit() const { return value && *value <= limit; }

bool Criterion::proved() const { return value && *value + expanded_uncertainty.value_or(0.0) <= limit; }

std::vector<Criterion> criteria(const calib::IdentificationResult& result, const Cell& cell,
                                std::optional<double> tip_box_rms_m) {
  std::vector<Criterion> list;
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role == calib::TouchRole::kHeldOut) add_held_out(face, noise_m(result, cell), cell, list);
  }
  std::optional<double> condition_number;
  if (!result.iterations.empty()) condition_number = result.iterations.back().condition_number;
  list.push_back({.name = "condition_number",
                  .unit = "1",
                  .value = condition_number,
                  .limit = cell.acceptance.condition_number_max});
  if (cell.acceptance.tip_box_rms_max_m) {
    list.push_back({.name = "tip_box_rms",
                    .unit = "mm",
                    .value = tip_box_rms_m ? std::optional(mm_from_metres(*tip_box_rms_m)) : std::nullopt,
                    .limit = mm_from_metres(*cell.acceptance.tip_box_rms_max_m)});
  }
  return list;
}

Judgement judge_by_rule(const calib::IdentificationResult& result,
                        const calib::IdentificationOptions& options, const Cell& cell,
                        std::optional<double> tip_box_rms_m, bool complete) {
  Judgement judgement = judge(result, options, cell.acceptance, tip_box_rms_m, complete);
  if (!cell.acceptance.guarded) return judgement;
  for (const Criterion& criterion : criteria(result, cell, tip_box_rms_m)) {
    if (!criterion.within_limit() || criterion.proved()) continue;  // outside: judge() has reported it
    judgement.reasons.push_back(fmt::format(
        "{}{} is {:.3f} {} with an expanded uncertainty of {:.3f} (k = 2): conformance with the limit of "
        "{:.3f} is not proved",
        criterion.name, criterion.plane ? fmt::format(" of plane {}", *criterion.plane) : "",
        *criterion.value, criterion.unit, criterion.expanded_uncertainty.value_or(0.0), criterion.limit));
  }
  judgement.accepted = judgement.reasons.empty();
  return judgement;
}

}  // namespace cell
