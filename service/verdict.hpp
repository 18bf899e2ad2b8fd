#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calib_core/identify.hpp"
#include "config/cell.hpp"

namespace cell {

/// What a run is worth. Apart from the state: a bad arm is a COMPLETE run that was rejected.
enum class Verdict { kNone, kAccepted, kRejected, kIncomplete };

std::string_view verdict_name(Verdict verdict);

struct Judgement {
  bool accepted = false;
  std::vector<std::string> reasons;  // why not, one sentence each
};

/// Holds a result against the cell's limits; `complete` says that every touch of the recipe was made.
Judgement judge(const calib::IdentificationResult& result, const AcceptanceLimits& limits, bool complete);

}  // namespace cell
