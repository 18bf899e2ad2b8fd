#pragma once

#include <optional>
#include <string>

#include "service/documents/fleet_document.hpp"

namespace cell {

/// Of a table of an archive, on one line: any cell may have written there what it likes, a line of another
/// cell too. "-" for nothing.
std::string table_field(const std::optional<std::string>& text);

/// A line a cell, for people; the columns are as wide as what is in them.
std::string fleet_text(const FleetDocument& fleet);

/// A line a month and type of arm.
std::string trends_text(const FleetTrendsDocument& document);

}  // namespace cell
