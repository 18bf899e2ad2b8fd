#pragma once

#include <string>
#include <vector>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What our own application keeps beyond the language: `start` sets every variable, constants (names that
/// begin with k) are never written, `stop` kills every task. Each
/// sentence names file and line. The application is resolved.
std::vector<std::string> broken_house_rules(const Application& application);

}  // namespace val3
