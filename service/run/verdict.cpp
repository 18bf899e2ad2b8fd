#include "service/run/verdict.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace cell {
namespace {

std::string not_proved(const Criterion& criterion) {
  const std::string uncertainty = criterion.expanded_uncertainty
                                      ? fmt::format("{:.3f} (k = 2)", *criterion.expanded_uncertainty)
                                      : "unknown size";
  return fmt::format(
      "{}{} is {:.3f} {} with an expanded uncertainty of {}: conformance with the limit of {:.3f} is not "
      "proved",
      criterion.name, criterion.plane ? fmt::format(" of plane {}", *criterion.plane) : "", *criterion.value,
      criterion.unit, uncertainty, criterion.limit);
}

}  // namespace

Judgement judge(const calib::IdentificationResult& result, const std::vector<Criterion>& criteria,
                const AcceptanceLimits& limits, bool complete) {
  Judgement judgement;
  std::vector<std::string>& reasons = judgement.reasons;
  if (!complete) reasons.emplace_back("the run was not completed");
  if (result.status != calib::IdentificationStatus::kConverged) reasons.push_back(result.message);
  for (const Criterion& criterion : criteria) {
    if (!criterion.within_limit()) {
      reasons.push_back(criterion.miss);
    } else if (limits.guarded && criterion.is_measured && !criterion.proved().value_or(false)) {
      reasons.push_back(not_proved(criterion));
    }
  }
  if (limits.guarded && std::ranges::none_of(criteria, &Criterion::is_measured))
    reasons.emplace_back("no touch was held out: nothing is proved of the limits for them; hold some out");
  judgement.accepted = reasons.empty();
  return judgement;
}

}  // namespace cell
