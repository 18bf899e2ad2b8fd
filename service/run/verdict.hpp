#pragma once

#include <string>
#include <vector>

#include "service/run/decision_rule.hpp"
#include "service/store/run_outcome.hpp"

namespace cell {

struct Judgement {
  bool accepted = false;
  std::vector<std::string> reasons;  // why not, one sentence each
};

/// Judges by all that can reject a result (criteria()) and the decision rule of the cell's file: a guarded
/// rule accepts only proved conformance.
Judgement judge(const std::vector<Criterion>& criteria, const AcceptanceLimits& limits);

}  // namespace cell
