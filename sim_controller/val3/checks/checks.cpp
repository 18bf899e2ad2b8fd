#include "sim_controller/val3/checks/checks.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "sim_controller/val3/checks/subject.hpp"

namespace val3 {
namespace {

auto order_of(const Finding& finding) {
  return std::tie(finding.at.file, finding.at.line, finding.at.column, finding.rule, finding.what);
}

}  // namespace

void check(const Application& application, const CheckOptions& options, Findings& findings) {
  Findings told;
  const ProgramGraph graph(application);
  const CheckSubject subject{.application = application,
                             .graph = graph,
                             .language = options.language.value_or(application.language),
                             .is_own = !options.language,
                             .findings = told};
  check_tasks(subject);
  check_loops(subject);
  check_flow(subject);
  check_locals(subject);
  check_globals(subject);
  check_channels(subject);
  check_constants(subject);
  check_traps(subject);
  check_versions(subject);
  findings.insert(findings.end(), std::make_move_iterator(told.begin()), std::make_move_iterator(told.end()));
  sort_findings(findings);
}

void sort_findings(Findings& findings) {
  std::ranges::stable_sort(findings,
                           [](const Finding& a, const Finding& b) { return order_of(a) < order_of(b); });
  const auto twice = std::ranges::unique(
      findings, [](const Finding& a, const Finding& b) { return order_of(a) == order_of(b); });
  findings.erase(twice.begin(), twice.end());
}

}  // namespace val3
