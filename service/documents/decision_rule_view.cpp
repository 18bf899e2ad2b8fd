#include "service/documents/decision_rule_view.hpp"

#include "service/documents/figures.hpp"

namespace cell {

DecisionRuleDocument decision_rule_of(const std::vector<Criterion>& criteria,
                                      const AcceptanceLimits& limits) {
  DecisionRuleDocument document{
      .standard = "ISO 14253-1:2017",
      .rule = limits.guarded ? "guarded" : "simple",
      .text = limits.guarded
                  ? "conformance is accepted where it is proved: value and expanded uncertainty (k = 2) are "
                    "within the limit, so that at least 97.7 % of such results conform; a figure without "
                    "an uncertainty is accepted within its limit"
                  : "by agreement in the cell's file a value within its limit is accepted; conformance "
                    "is proved only where value and expanded uncertainty (k = 2) are within the limit",
      .coverage_factor = kCoverageFactor};
  for (const Criterion& criterion : criteria) {
    document.criteria.push_back({.name = criterion.name,
                                 .plane = criterion.plane,
                                 .tool = criterion.tool,
                                 .unit = criterion.unit,
                                 .value = finite(criterion.value),
                                 .side = criterion.at_least ? "lower" : "upper",
                                 .limit = finite(criterion.limit),
                                 .expanded_uncertainty = finite(criterion.expanded_uncertainty),
                                 .within_limit = criterion.within_limit(),
                                 .proved = criterion.proved()});
  }
  return document;
}

}  // namespace cell
