#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "service/run/run_conditions.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// A qualification counts for the calibrations of this time after it: a stylus is soon knocked.
inline constexpr std::chrono::hours kQualifiedFor{24};

/// What the newest qualification measured of the noise of a touch. Nothing where there is none, where it did
/// not pass, ended longer ago or later than `now`, or was made with other files than the cell has now
/// (`config_digest`). Nothing also where it cannot be read, which the log says: it forbids no calibration.
std::optional<QualifiedNoise> qualification_that_counts(const RunStore& store,
                                                        const std::optional<std::string>& config_digest,
                                                        std::chrono::system_clock::time_point now);

}  // namespace cell
