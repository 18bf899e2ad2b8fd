#pragma once

#include <string>

#include "service/documents/checks_document.hpp"

namespace cell {

/// The checks as a table for a terminal of 80 columns, newest last, each figure that is beyond a limit
/// marked, and what to do.
std::string checks_text(const ChecksDocument& document);

}  // namespace cell
