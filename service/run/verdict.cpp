#include "service/run/verdict.hpp"

#include <spdlog/fmt/fmt.h>

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

Judgement judge(const std::vector<Criterion>& criteria, const AcceptanceLimits& limits) {
  Judgement judgement;
  std::vector<std::string>& reasons = judgement.reasons;
  for (const Criterion& criterion : criteria) {
    if (!criterion.within_limit()) {
      reasons.push_back(criterion.miss);
    } else if (limits.guarded && criterion.is_measured && !criterion.proved().value_or(false)) {
      reasons.push_back(not_proved(criterion));
    }
  }
  judgement.accepted = reasons.empty();
  return judgement;
}

}  // namespace cell
