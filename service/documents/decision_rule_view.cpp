#include "service/documents/decision_rule_view.hpp"

#include "service/documents/figures.hpp"

namespace cell {

DecisionRuleDocument decision_rule_of(const std::vector<Criterion>& criteria,
                                      const AcceptanceLimits& limits) {
  DecisionRuleDocument document{
      .standard = "ISO 14253-1",
      .rule = limits.guarded ? "guarded" : "simple",
      .text = limits.guarded
                  ? "conformance is accepted where it is proved: value and expanded uncertainty are "
                    "within the limit"
                  : "by agreement in the cell's file a value within its limit is accepted; conformance "
                    "is proved only where value and expanded uncertainty are within the limit",
      .coverage_factor = kCoverageFactor};
  for (const Criterion& criterion : criteria) {
    document.criteria.push_back({.name = criterion.name,
                                 .plane = criterion.plane,
                                 .unit = criterion.unit,
                                 .value = finite(criterion.value),
                                 .limit = finite(criterion.limit),
                                 .expanded_uncertainty = finite(criterion.expanded_uncertainty),
                                 .within_limit = criterion.within_limit(),
                                 .proved = criterion.proved()});
  }
  return document;
}

}  // namespace cell
