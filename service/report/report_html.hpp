#pragma once

#include <string>

#include "service/documents/run_report.hpp"
#include "service/report/words/words.hpp"

namespace cell {

/// A report as one self-contained HTML document for reading and printing: no script, no external resources.
/// Values that an older result lacks are shown as unknown. Its first page is for signatures; printed, each
/// page has the report's number and its own of how many at its head. `issued_at`: RFC 3339.
std::string report_html(const RunReport& report, const std::string& issued_at,
                        const Words& words = english());

}  // namespace cell
