#include "service/documents/comparison_view.hpp"

#include <spdlog/fmt/fmt.h>

#include "calib_core/geometry/units.hpp"
#include "service/documents/figures.hpp"

namespace cell {
namespace {

constexpr double kPerMillionth = 1e6;

ComparisonDocument::Part part_told(const calib::ComparedErrors& compared) {
  if (compared.combinations.empty()) return {};
  ComparisonDocument::Part part{.changed = compared.has_changed(),
                                .p = finite(compared.p),
                                .chi_square = finite(compared.chi_square),
                                .degrees_of_freedom = finite(compared.degrees_of_freedom),
                                .combinations = {}};
  for (const calib::Combination& combination : compared.combinations) {
    part.combinations.push_back({.e_n = finite(combination.e_n), .shares = {}});
    for (const calib::Combination::Share& share : combination.shares)
      part.combinations.back().shares.push_back(
          {.parameter = calib::arm_parameter_name(share.parameter), .share = finite(share.share)});
  }
  return part;
}

std::optional<double> in_box_mm(const calib::TipRegion& box, const calib::ArmCovariance& covariance) {
  const auto rms_m = box.rms_m(covariance);
  return rms_m ? finite(calib::mm_from_metres(*rms_m)) : std::nullopt;
}

std::string largest_of(const ComparisonDocument::Part& part) {
  std::string names;
  for (const ComparisonDocument::Share& share : part.combinations.front().shares)
    names += (names.empty() ? "" : ", ") + share.parameter;
  return names;
}

}  // namespace

ComparisonDocument comparison_view(std::int64_t earlier, std::int64_t later,
                                   const calib::Comparison& comparison, const calib::TipRegion& box) {
  ComparisonDocument document;
  document.earlier = std::to_string(earlier);
  document.later = std::to_string(later);
  document.p_min = calib::kComparisonP;
  document.growth_ppm = finite(kPerMillionth * comparison.growth);
  document.std_growth_ppm = finite(kPerMillionth * comparison.std_growth);
  document.tip_difference_mm = in_box_mm(box, comparison.difference * comparison.difference.transpose());
  document.std_tip_difference_mm = in_box_mm(box, comparison.covariance);
  document.arm = part_told(comparison.arm);
  document.tool = part_told(comparison.tool);
  document.verdict.accepted = !document.arm.changed.value_or(false) && !document.tool.changed.value_or(false);
  if (!document.tool.changed)
    document.verdict.reasons.emplace_back(
        "of the stylus nothing was identified by both runs: it is not compared");
  if (document.arm.changed.value_or(false))
    document.verdict.reasons.push_back(
        fmt::format("the arm has changed between run {} and run {}, most of all in {}: look for a collision "
                    "or a repair in between, and approve the later run",
                    earlier, later, largest_of(document.arm)));
  if (document.tool.changed.value_or(false))
    document.verdict.reasons.push_back(
        fmt::format("the stylus was changed or has bent between run {} and run {}", earlier, later));
  return document;
}

}  // namespace cell
