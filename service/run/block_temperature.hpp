#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "config/cell.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// Who told the temperature of the block: its file, or whoever started the run.
enum class TemperatureSource { kFile, kRun };
std::string_view temperature_source_name(TemperatureSource source);  // "file", "run"

/// How far ahead of the daemon's clock the time of a measurement may be: that of clocks that differ.
inline constexpr std::chrono::seconds kClockDifferenceMax{30};

/// Why no run may begin with a temperature.
struct TemperatureRefusal {
  std::string code;   // temperature_missing, expansion_missing, temperature_old, temperature_in_future
  std::string words;  // which file or request, the pointer in it, what is wrong, what to do
};

/// Whether a run that starts `now` may begin with `given`, the temperature of its request, or without it with
/// that of the cell's block: known, and neither older than block_temperature_age_max nor of the future.
std::optional<TemperatureRefusal> refuse_temperature(const Cell& cell,
                                                     const std::optional<BlockTemperature>& given,
                                                     std::chrono::system_clock::time_point now);

/// Why a temperature that is given cannot be used: nobody knows how the block grows with it.
std::optional<std::string> unknown_expansion_reason(const Cell& cell);

/// Why the block of a result from touches without a date is not as certain as it looks. It can grow and has
/// no temperature: it is taken as of the 20 degrees C of its certificate. Or its file's temperature is not of
/// `now`, for which a run would be refused, in the same words: the touches may be as old, which nobody knows.
/// Nothing where the temperature is known at any time.
std::optional<std::string> temperature_warning(const Cell& cell, std::chrono::system_clock::time_point now);

/// What the store keeps of a run's temperature: `given`, or without it that of the cell's block; nothing when
/// that is unknown too.
std::optional<StoredTemperature> temperature_to_store(const Cell& cell,
                                                      const std::optional<BlockTemperature>& given);

/// The temperature that came with a stored run; nothing where the block's file gave it.
std::optional<BlockTemperature> temperature_given_to(const StoredRun& run, const Cell& cell);

/// The temperature that a stored run was made at, whoever told it; what an older daemon did not keep is the
/// cell's. Nothing when the run kept none.
std::optional<BlockTemperature> temperature_of(const StoredRun& run, const Cell& cell);

}  // namespace cell
