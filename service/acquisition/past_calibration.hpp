#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "service/run/verification.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// The run that a run of this kind is of where none is named: the newest calibration that was accepted, and
/// of all but a proof the one whose model a person approved, where there is one. Nothing where there is none.
std::optional<std::int64_t> calibration_of_cell(const RunStore& store, RunKind kind);

/// What the store has of the calibration that a proof or a check is of: that of run `of_run`; where none is
/// named, calibration_of_cell(). Refused: one that was not accepted, or was made with other files than the
/// cell has now (`config_digest`). Throws what the store throws.
std::variant<PastCalibration, VerificationRefusal> find_calibration(
    const RunStore& store, RunKind kind, std::optional<std::int64_t> of_run,
    const std::optional<std::string>& config_digest);

}  // namespace cell
