#pragma once

#include <string>

#include "service/documents/run_report.hpp"

namespace cell {

/// A report as one self-contained HTML document for reading and printing: no script, no external resources.
/// Values that an older result lacks are shown as unknown.
std::string report_html(const RunReport& report);

}  // namespace cell
