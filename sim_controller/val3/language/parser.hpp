#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/program/finding.hpp"
#include "sim_controller/val3/program/syntax.hpp"

namespace val3 {

/// A program's code, from `begin` to `end`, as lines with their blocks linked. `first_line` is the line of
/// the file in which `code` begins. A line that cannot be parsed is found and left out; the others are kept.
/// Expressions nested deeper than kExpressionDepthMax are refused.
std::vector<Line> parse(std::string_view code, const std::string& file, int first_line, Findings& findings);

inline constexpr int kExpressionDepthMax = 64;
/// After as many the rest of a program is not read, which is told.
inline constexpr std::size_t kFindingsPerProgramMax = 100;

}  // namespace val3
