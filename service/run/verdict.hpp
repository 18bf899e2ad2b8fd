#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/store/run_outcome.hpp"

namespace cell {

struct Judgement {
  bool accepted = false;
  std::vector<std::string> reasons;  // why not, one sentence each
};

/// If a larger share of the touches is rejected, the others are not trusted either.
inline constexpr double kRejectedShareMax = 0.1;

/// True if the result holds an error for this candidate: with a prior every one that is not excluded, else
/// the identified ones.
bool is_estimated(const calib::IdentificationOptions& options, const calib::IdentifiableSet& identifiable,
                  int index);

/// Compares a result with the cell's limits. `tip_box_rms_m` is the uncertainty predicted over the workspace
/// box; an absent figure misses a limit. `complete`: every touch of the recipe was made.
Judgement judge(const calib::IdentificationResult& result, const calib::IdentificationOptions& options,
                const AcceptanceLimits& limits, std::optional<double> tip_box_rms_m, bool complete);

}  // namespace cell
