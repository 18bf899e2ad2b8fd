#include "sim_controller/val3/checks/report.hpp"

#include <algorithm>
#include <ostream>

#include "sim_controller/val3/checks/rules.hpp"

namespace val3 {
namespace {

void write_place(const Position& at, std::ostream& out) {
  out << at.file;
  if (at.line > 0) out << ':' << at.line;
  if (at.line > 0 && at.column > 0) out << ':' << at.column;
  out << ": ";
}

std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace

std::string_view name_of(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    default:
      return "note";
  }
}

FindingCounts count_findings(const Findings& findings) {
  const auto count = [&](Severity severity) {
    return static_cast<std::size_t>(std::ranges::count(findings, severity, &Finding::severity));
  };
  return {count(Severity::kError), count(Severity::kWarning), count(Severity::kNote)};
}

void write_text(const Findings& findings, std::size_t projects, std::ostream& out) {
  for (const Finding& finding : findings) {
    write_place(finding.at, out);
    out << name_of(finding.severity) << ": " << finding.what << " [" << finding.rule << "]\n";
    const Rule* const rule = find_rule(finding.rule);
    if (rule != nullptr && !rule->why.empty()) out << "    " << rule->why << '\n';
    if (!finding.remedy.empty())
      out << "    Remedy: " << finding.remedy << '\n';
    else if (rule != nullptr && !rule->remedy.empty())
      out << "    Remedy: " << rule->remedy << '\n';
  }
  const FindingCounts counts = count_findings(findings);
  out << counted(counts.errors, "error") << ", " << counted(counts.warnings, "warning") << ", "
      << counted(counts.notes, "note") << " in " << counted(projects, "project") << '\n';
}

}  // namespace val3
