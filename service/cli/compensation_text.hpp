#pragma once

#include <string>

#include "service/documents/compensation_document.hpp"

namespace cell {

/// A line a target and a sum, for people.
std::string compensation_text(const CompensationDocument& document, const std::string& tool);

}  // namespace cell
