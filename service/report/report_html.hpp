#pragma once

#include <string>

#include "service/documents/run_report.hpp"

namespace cell {

/// A report as one self-contained HTML document for people and for print: no script, nothing
/// from elsewhere. What an older result does not hold is said to be unknown.
std::string report_html(const RunReport& report);

}  // namespace cell
