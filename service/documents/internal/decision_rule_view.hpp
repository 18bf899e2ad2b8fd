#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "service/run/decision_rule.hpp"

namespace cell {

/// `decision_rule` of a verdict: the standard, the rule that this cell applies, and every criterion.
nlohmann::ordered_json decision_rule_json(const std::vector<Criterion>& criteria,
                                          const AcceptanceLimits& limits);

}  // namespace cell
