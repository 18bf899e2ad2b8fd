#pragma once

#include <iosfwd>
#include <string_view>

#include "sim_controller/val3/program/finding.hpp"

namespace val3 {

/// Findings as SARIF 2.1.0 (OASIS), which editors and CI services show at the lines: one run, its rules, and
/// a result for each finding. A file's name becomes a relative or a file: URI.
void write_sarif(const Findings& findings, std::string_view tool_version, std::ostream& out);

}  // namespace val3
