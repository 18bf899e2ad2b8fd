#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "service/documents/fleet_document.hpp"

/// All cells of an archive at once. `url`: of who may read all; of who may not, what it shows is what that
/// user may see. Each throws std::runtime_error where the archive cannot be read, also where a query of it
/// takes longer than `patience` (none: however long).
namespace cell {

/// By name.
FleetDocument fleet_of(const std::string& url, const std::optional<std::chrono::milliseconds>& patience = {});

/// Upper bound of `months`.
inline constexpr int kTrendMonthsMax = 240;

/// Of this month and those before it, `months` in all, by the clock of the archive.
FleetTrendsDocument trends_of(const std::string& url, int months,
                              const std::optional<std::chrono::milliseconds>& patience = {});

}  // namespace cell
