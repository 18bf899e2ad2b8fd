#pragma once

#include <spdlog/fmt/fmt.h>

#include <optional>
#include <string>

namespace cell {

/// A figure in a form of fmt ("{:.3f}"), a dash where it is unknown.
inline std::string figure_or_dash(const std::optional<double>& value, const char* form) {
  return value ? fmt::format(fmt::runtime(form), *value) : "-";
}

}  // namespace cell
