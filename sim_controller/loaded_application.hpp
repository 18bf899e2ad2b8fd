#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "sim_controller/val3/program/application.hpp"
#include "sim_controller/val3/program/finding.hpp"

namespace sim {

/// The VAL3 application in a folder or of a .pjx, read and resolved, for --val3 and --run alike. Nothing
/// where a controller would not load it: `error` has the errors with file and line then, and what tells more.
std::optional<val3::Application> loaded_application(const std::string& folder, std::ostream& error);

/// Writes the errors among the findings, a line each: file, line, what, remedy, rule. True when there were
/// any.
bool tell_errors(const val3::Findings& findings, std::ostream& error);

}  // namespace sim
