#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"

namespace cell {

/// What a run is worth. Apart from the state: a bad arm is a COMPLETE run that was rejected.
enum class Verdict { kNone, kAccepted, kRejected, kIncomplete };

std::string_view verdict_name(Verdict verdict);

struct Judgement {
  bool accepted = false;
  std::vector<std::string> reasons;  // why not, one sentence each
};

/// More of the touches than this were rejected: the others are not to be trusted either.
inline constexpr double kRejectedShareMax = 0.1;

/// Whether the result holds an error for this candidate: with a prior all that are not excluded, else the
/// identified ones.
bool is_estimated(const calib::IdentificationOptions& options, const calib::IdentifiableSet& identifiable,
                  int index);

/// Holds a result against the cell's limits. `tip_box_rms_m` is the uncertainty predicted over the workspace
/// box, nothing when there is no honest figure (which misses a limit); `complete` says that every touch of
/// the recipe was made.
Judgement judge(const calib::IdentificationResult& result, const calib::IdentificationOptions& options,
                const AcceptanceLimits& limits, std::optional<double> tip_box_rms_m, bool complete);

}  // namespace cell
