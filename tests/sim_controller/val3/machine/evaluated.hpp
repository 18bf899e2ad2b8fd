#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/val3/running.hpp"

namespace val3 {

/// What a num expression is worth, and with which error its line ends (1: none). `declared` adds data to the
/// project; there are num n[20], bool b, string s[8], trsf t[4] and jointRx j[4] already.
struct Evaluated {
  double number = NAN;
  int error = 1;
};

inline SmallProject& with_variables(SmallProject& project) {
  project.number("n", 20).flag("b", 4).data("s", "string", "", 8).data("t", "trsf", "", 4);
  return project.data("j", "jointRx", "", 4);
}

/// Runs lines, then `n[0]=expression`.
inline Evaluated evaluated(const std::string& expression, const std::string& lines_before = "") {
  SmallProject project;
  with_variables(project).program("start", lines_before + "\nn[0]=" + expression + "\nn[19]=1\nwait(false)");
  Running run(project);
  run.ticks(4);
  Evaluated result;
  result.error = run.machine().task_status("small~");
  if (run.number("n", 19) == 1.0) result.number = run.number("n", 0);
  return result;
}

/// Each expression and its value.
inline void expect_values(const std::vector<std::pair<std::string, double>>& cases, double within = 1e-12) {
  for (const auto& [expression, value] : cases) {
    const Evaluated result = evaluated(expression);
    EXPECT_EQ(result.error, 1) << expression;
    EXPECT_NEAR(result.number, value, within) << expression;
  }
}

/// Each expression and the error that its line ends with.
inline void expect_errors(const std::vector<std::pair<std::string, int>>& cases,
                          const std::string& before = "") {
  for (const auto& [expression, error] : cases)
    EXPECT_EQ(evaluated(expression, before).error, error) << expression;
}

}  // namespace val3
