#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tests/simulation/fault_table_document.hpp"

namespace simulation {

/// Runs every cell; `progress` gets a line a row.
std::vector<TableRow> make_table(std::FILE* progress);

/// The first line in which two documents differ, with what stands in each; empty where they are the same.
std::string first_difference(const std::string& made, const std::string& given);

}  // namespace simulation
