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

/// Judges a result by all figures that can reject it (criteria()) and the decision rule of the cell's file: a
/// guarded rule accepts only proved conformance. `complete`: every touch of the recipe was made.
Judgement judge(const calib::IdentificationResult& result, const std::vector<Criterion>& criteria,
                const AcceptanceLimits& limits, bool complete);

}  // namespace cell
