#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "service/documents/checks_document.hpp"
#include "service/documents/verification_document.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// A check that came to its end, with its result.
struct EndedCheck {
  StoredRun run;
  CheckDocument result;
};

/// The checks of a calibration, oldest first, as charts. A check that alarms while the base of the charts is
/// not whole is in none: their limits are those of a cell that has not changed. `every`: how often the cell
/// is to be checked, nothing for a calibration that was replaced; counted from the newest check, or from the
/// calibration where there is none.
ChecksDocument checks_view(const StoredRun& calibration, const std::vector<EndedCheck>& checks,
                           std::optional<std::chrono::days> every, std::chrono::system_clock::time_point now);

}  // namespace cell
