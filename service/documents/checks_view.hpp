#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "service/documents/checks_document.hpp"
#include "service/documents/verification_document.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// A check that came to its end, with its result.
struct EndedCheck {
  StoredRun run;
  CheckDocument result;
  std::vector<calib::Touch> touches = {};  // of one that may_be_reference(); else none are needed
};

/// The newest check with a verdict, of checks that are oldest first: one without takes nothing back. Null
/// where none has one.
const EndedCheck* newest_judged(const std::vector<EndedCheck>& checks);

/// The checks of a calibration, oldest first, as charts. A check that alarms is held against the limits, and
/// changes neither them nor the weighted means: they are of a cell that has not changed. `every`: how often
/// the cell is to be checked, nothing for a calibration that was replaced; counted from the newest check that
/// has a verdict or is part of the reference, or from the calibration where there is none. `arm`: the cell's
/// nominal one, as for reference_among().
ChecksDocument checks_view(const StoredRun& calibration, const std::vector<EndedCheck>& checks,
                           const calib::KinematicModel& arm, std::optional<std::chrono::days> every,
                           std::chrono::system_clock::time_point now);

/// Leaves out all but the newest checks and their points; what was made of all stays.
void keep_newest(ChecksDocument& document, std::size_t limit);

}  // namespace cell
