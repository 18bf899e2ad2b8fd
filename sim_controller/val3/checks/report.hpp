#pragma once

#include <cstddef>
#include <iosfwd>

#include "sim_controller/val3/program/finding.hpp"

namespace val3 {

struct FindingCounts {
  std::size_t errors = 0, warnings = 0, notes = 0;
};
FindingCounts count_findings(const Findings& findings);
/// "error", "warning", "note".
std::string_view name_of(Severity severity);

/// For people: "file:line:column: error: what [rule]", below it why and what to do, at the end the counts.
void write_text(const Findings& findings, std::size_t projects, std::ostream& out);

}  // namespace val3
