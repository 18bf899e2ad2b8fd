#pragma once

#include <cstdint>
#include <memory>
#include <optional>

namespace spdlog {
class formatter;
}

namespace cell {

/// Of what the daemon's log is about now: each line tells it, whoever writes the line.
void set_logged_run(std::optional<std::int64_t> run_id);
/// From 1, as the store counts; nothing between touches.
void set_logged_touch(std::optional<int> number);

/// A line for people: time, level, run and touch where there are, message.
std::unique_ptr<spdlog::formatter> text_log_format();

/// An object a line: {"time":RFC 3339,"level":...,"message":...,"run":"7","touch":12}; run and touch are null
/// where there is none. `run` is a text as everywhere in the API.
std::unique_ptr<spdlog::formatter> json_log_format();

}  // namespace cell
