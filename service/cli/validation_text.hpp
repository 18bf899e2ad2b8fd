#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// A validation document (touchcal/validation/1) as text, in the form of the paper's Tables IV to VII.
std::string validation_text(const nlohmann::json& validation);

}  // namespace cell
