#pragma once

#include <cstdint>
#include <memory>
#include <optional>

namespace spdlog {
class formatter;
}

namespace cell {

/// Sets the run that every log line names, until the next call.
void set_logged_run(std::optional<std::int64_t> run_id);
/// The touch likewise, from 1 as in the store; nothing between touches.
void set_logged_touch(std::optional<int> number);

/// One line of text: time, level, run and touch if any, message.
std::unique_ptr<spdlog::formatter> text_log_format();

/// One JSON object per line: {"time":RFC 3339,"level":...,"message":...,"run":"7","touch":12}; run and touch
/// may be null. `run` is a string, as everywhere in the API.
std::unique_ptr<spdlog::formatter> json_log_format();

}  // namespace cell
