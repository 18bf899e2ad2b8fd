#include "sim_controller/loaded_application.hpp"

#include <ostream>
#include <utility>

#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

namespace sim {

bool tell_errors(const val3::Findings& findings, std::ostream& error) {
  bool any = false;
  for (const val3::Finding& finding : findings) {
    if (finding.severity != val3::Severity::kError) continue;
    any = true;
    error << finding.at.file << ':' << finding.at.line << ": " << finding.what
          << (finding.remedy.empty() ? "" : "; " + finding.remedy) << " [" << finding.rule << "]\n";
  }
  return any;
}

std::optional<val3::Application> loaded_application(const std::string& folder, std::ostream& error) {
  val3::ReadApplication read = val3::read_application(folder);
  val3::resolve(read.application, read.findings);
  if (!tell_errors(read.findings, error)) return std::move(read.application);
  error << folder << ": a controller would not load it; `cs8sim --check` tells more\n";
  return std::nullopt;
}

}  // namespace sim
