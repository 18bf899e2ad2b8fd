#include "service/run/verdict.hpp"

#include <spdlog/fmt/fmt.h>

namespace cell {
namespace {

std::string not_proved(const Criterion& criterion) {
  return fmt::format(
      "{}{} is {:.3f} {} with an expanded uncertainty of {:.3f} (k = 2): conformance with the limit of "
      "{:.3f} "
      "is not proved",
      criterion.name, criterion.plane ? fmt::format(" of plane {}", *criterion.plane) : "", *criterion.value,
      criterion.unit, *criterion.expanded_uncertainty, criterion.limit);
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
    } else if (limits.guarded && criterion.proved() == false) {
      reasons.push_back(not_proved(criterion));
    }
  }
  judgement.accepted = reasons.empty();
  return judgement;
}

}  // namespace cell
