#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// A report (report_json) as one self-contained HTML document for reading and printing: no script, no
/// external resources. Values that an older result lacks are shown as unknown.
std::string report_html(const nlohmann::ordered_json& report);

}  // namespace cell
