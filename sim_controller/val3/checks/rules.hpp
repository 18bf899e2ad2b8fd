#pragma once

#include <span>
#include <string_view>

#include "sim_controller/val3/program/finding.hpp"

namespace val3 {

/// A rule that findings are of.
struct Rule {
  std::string_view id;    // "array-by-value"
  Severity severity;      // as a rule
  std::string_view what;  // one sentence, without the place
  std::string_view why;   // what the controller does; with the manual's page where there is one
  std::string_view remedy;
};

std::span<const Rule> all_rules();
/// Null for an id that is none.
const Rule* find_rule(std::string_view id);

}  // namespace val3
