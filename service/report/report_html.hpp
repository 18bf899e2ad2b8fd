#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// A report (report_json) as one self-contained HTML document for people and for print: no script, nothing
/// from elsewhere. What an older result does not hold is said to be unknown.
std::string report_html(const nlohmann::ordered_json& report);

}  // namespace cell
