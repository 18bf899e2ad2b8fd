#include "service/run/block_temperature.hpp"

#include <spdlog/fmt/fmt.h>

#include "config/utc_text.hpp"
#include "service/base/utc_time.hpp"

namespace cell {
namespace {

constexpr const char* kMeasureAgain =
    "measure the block's temperature and give it with the run (touchcal run --block-temperature C "
    "--std-block-temperature K)";

/// The file or the request, and the pointer of the time in it.
std::string time_place(const Cell& cell, TemperatureSource source) {
  return source == TemperatureSource::kRun ? "the request: /block_temperature_at"
                                           : cell.block.file.string() + ": /temperature_at";
}

constexpr const char* kEnterThere = ", or enter it there with its time";

std::string remedy(TemperatureSource source) {
  return source == TemperatureSource::kRun ? std::string(kMeasureAgain)
                                           : std::string(kMeasureAgain) + kEnterThere;
}

std::string hours_text(std::chrono::system_clock::duration time) {
  return fmt::format("{:.1f} h", std::chrono::duration<double, std::chrono::hours::period>(time).count());
}

std::optional<TemperatureRefusal> refuse_time(const Cell& cell, TemperatureSource source,
                                              std::chrono::system_clock::time_point measured_at,
                                              std::chrono::system_clock::time_point now,
                                              const std::string& what_to_do) {
  if (measured_at - now > kClockDifferenceMax) {
    return TemperatureRefusal{
        "temperature_in_future",
        fmt::format("{}: the block's temperature is of {}, which is still to come, it is {} now; correct the "
                    "time or set this computer's clock",
                    time_place(cell, source), format_utc(measured_at), format_utc(now))};
  }
  if (now - measured_at <= cell.block_temperature_age_max) return std::nullopt;
  return TemperatureRefusal{
      "temperature_old",
      fmt::format("{}: the block's temperature of {:.1f} degrees C is {} old, more than {} "
                  "(block_temperature_age_max_h of the cell's file); {}",
                  time_place(cell, source), *cell.block.temperature_c, hours_text(now - measured_at),
                  hours_text(cell.block_temperature_age_max), what_to_do)};
}

}  // namespace

std::string_view temperature_source_name(TemperatureSource source) {
  switch (source) {
    case TemperatureSource::kFile:
      return "file";
    case TemperatureSource::kRun:
      return "run";
  }
  return "";
}

std::optional<std::string> unknown_expansion_reason(const Cell& cell) {
  if (cell.block.thermal_expansion_per_k) return std::nullopt;
  return fmt::format(
      "{}: /thermal_expansion_per_k is missing, without which a temperature says nothing of the block's "
      "size; "
      "add it, in a file of schema touchcal/block/2",
      cell.block.file.string());
}

std::optional<std::string> temperature_warning(const Cell& cell, std::chrono::system_clock::time_point now) {
  if (!cell.block.thermal_expansion_per_k) return std::nullopt;
  if (cell.block.temperature_c) {
    if (!cell.block.temperature_at) return std::nullopt;
    const auto refusal =
        refuse_time(cell, TemperatureSource::kFile, *cell.block.temperature_at, now,
                    std::string("give that of the block at the touches with --block-temperature and "
                                "--std-block-temperature") +
                        kEnterThere);
    return refusal ? std::optional(refusal->words) : std::nullopt;
  }
  return fmt::format(
      "{}: /temperature_c is missing beside thermal_expansion_per_k: the block is taken as of 20 degrees C "
      "exactly, and no uncertainty has its growth of {:.3g} ppm per kelvin; give its temperature with "
      "--block-temperature and --std-block-temperature, or enter it there",
      cell.block.file.string(), 1e6 * *cell.block.thermal_expansion_per_k);
}

std::optional<TemperatureRefusal> refuse_temperature(const Cell& cell,
                                                     const std::optional<BlockTemperature>& given,
                                                     std::chrono::system_clock::time_point now) {
  const Cell there = with_block_temperature(cell, given);
  if (!there.block.temperature_c) {
    return TemperatureRefusal{
        "temperature_missing",
        fmt::format("{}: the temperature of the block {} is unknown; {}, or enter it there (temperature_c)",
                    cell.block.file.string(), cell.block.name, kMeasureAgain)};
  }
  if (const auto gap = unknown_expansion_reason(there)) return TemperatureRefusal{"expansion_missing", *gap};
  if (!there.block.temperature_at) return std::nullopt;
  const TemperatureSource source = given ? TemperatureSource::kRun : TemperatureSource::kFile;
  return refuse_time(there, source, *there.block.temperature_at, now, remedy(source));
}

std::optional<StoredTemperature> temperature_to_store(const Cell& cell,
                                                      const std::optional<BlockTemperature>& given) {
  const Block block = with_block_temperature(cell, given).block;
  if (!block.temperature_c) return std::nullopt;
  const TemperatureSource source = given ? TemperatureSource::kRun : TemperatureSource::kFile;
  StoredTemperature stored{.celsius = *block.temperature_c,
                           .std_k = block.std_temperature_k,
                           .measured_at = std::nullopt,
                           .source = std::string(temperature_source_name(source))};
  if (block.temperature_at) stored.measured_at = format_utc(*block.temperature_at);
  return stored;
}

std::optional<BlockTemperature> temperature_given_to(const StoredRun& run, const Cell& cell) {
  const bool was_given = run.block_temperature &&
                         run.block_temperature->source == temperature_source_name(TemperatureSource::kRun);
  return was_given ? temperature_of(run, cell) : std::nullopt;
}

std::optional<BlockTemperature> temperature_of(const StoredRun& run, const Cell& cell) {
  const auto& stored = run.block_temperature;
  if (!stored) return std::nullopt;
  return BlockTemperature{
      .celsius = stored->celsius,
      .std_k = stored->std_k.value_or(cell.block.std_temperature_k),
      .measured_at = stored->measured_at ? time_from_utc(*stored->measured_at) : std::nullopt};
}

}  // namespace cell
