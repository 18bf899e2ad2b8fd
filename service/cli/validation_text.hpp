#pragma once

#include <string>

#include "service/documents/validation_document.hpp"

namespace cell {

/// A validation document (touchcal/validation/1) as text, in the form of the paper's Tables IV to VII.
std::string validation_text(const ValidationDocument& validation);

}  // namespace cell
