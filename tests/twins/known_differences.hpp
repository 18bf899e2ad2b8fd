#pragma once

#include <span>
#include <string_view>

#include "tests/twins/comparison.hpp"
#include "tests/twins/scenario.hpp"

namespace twins {

/// One thing in which the twins may differ.
struct KnownDifference {
  std::string_view scenario;  // part of its name; empty: any
  std::string_view where;     // how Difference::where begins
  std::string_view reason;
  std::string_view page;  // section of PROTOCOL.md, or page of a manual
};

std::span<const KnownDifference> known_differences();
/// Null where it is not in the list.
const KnownDifference* known(const Scenario& scenario, const Difference& found);

/// A fault that no scenario has, and why.
struct LeftOut {
  std::string_view fault;
  std::string_view reason;
};
std::span<const LeftOut> left_out();

}  // namespace twins
