#pragma once

#include <vector>

#include "tests/val3/program.hpp"
#include "tests/val3/xml.hpp"

namespace val3 {

/// The variables of a .dtx file into `application`, with the values that stand there.
void read_data(const Element& database, const std::string& file, Application& application,
               std::vector<Problem>& problems);

}  // namespace val3
