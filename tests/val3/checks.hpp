#pragma once

#include <string>
#include <vector>

#include "tests/val3/program.hpp"

namespace val3 {

struct CheckOptions {
  /// Globals whose name begins so are constants: they keep the value of the data file and are never assigned.
  std::string constant_prefix = "k";
};

/// What the language or our rules forbid, found without running anything: unknown names, types, arguments,
/// names that are too long or taken, globals that `start` does not set, tasks that `stop` does not kill,
/// waiting in a synchronous task, what nobody uses. Empty when all is well.
std::vector<Problem> check(const Application& application, const CheckOptions& options = {});

/// Types and names in each program alone; the first part of `check`.
void check_types(const Application& application, std::vector<Problem>& problems);

/// The globals that a program assigns or hands on by reference; `constants` are not told from others.
std::vector<std::string> written_names(const Application& application, const Program& program);

}  // namespace val3
