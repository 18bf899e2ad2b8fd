#pragma once

#include <string>

#include "service/documents/comparison_document.hpp"

namespace cell {

/// Two calibrations compared, for a terminal of 80 columns: the verdict, the growth, how much the tip
/// differs, and the combinations that differ most.
std::string comparison_text(const ComparisonDocument& document);

}  // namespace cell
