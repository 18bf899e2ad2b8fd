#pragma once

#include <vector>

#include "tests/twins/scenario.hpp"

namespace twins {

std::vector<Scenario> whole_runs();
std::vector<Scenario> measurements();
std::vector<Scenario> interrupted_touches();
std::vector<Scenario> interrupted_second_touches();
std::vector<Scenario> interrupted_ways_back();
std::vector<Scenario> sequences();
std::vector<Scenario> fields();
std::vector<Scenario> links();
std::vector<Scenario> permits();

}  // namespace twins
