#pragma once

#include <vector>

#include "service/documents/result_document.hpp"
#include "service/run/decision_rule.hpp"

namespace cell {

/// `decision_rule` of a verdict: the standard, the rule that this cell applies, and every criterion.
DecisionRuleDocument decision_rule_of(const std::vector<Criterion>& criteria, const AcceptanceLimits& limits);

}  // namespace cell
