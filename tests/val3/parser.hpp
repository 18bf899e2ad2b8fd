#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/val3/program.hpp"

namespace val3 {

/// The statements of a program's code ("begin" ... "end"), laid out flat. `first_line` is that of the code in
/// `file`. Throws Problem at the first mistake of grammar or block structure.
std::vector<Statement> parse(std::string_view code, const std::string& file, int first_line);

}  // namespace val3
