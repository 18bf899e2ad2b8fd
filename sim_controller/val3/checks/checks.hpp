#pragma once

#include <optional>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

struct CheckOptions {
  std::optional<Version> language;  // deviations from this version are told; else from the project's own
};

/// What a controller takes and a programmer would not want: blocking calls in synchronous tasks, periods that
/// are no multiple of 4 ms, sockets never closed, lines never reached, variables never set, names too long,
/// deviations by version. The application is resolved.
/// The findings that were there before are sorted in.
void check(const Application& application, const CheckOptions& options, Findings& findings);
/// By file, line, column and rule; what is told twice is left once.
void sort_findings(Findings& findings);

}  // namespace val3
