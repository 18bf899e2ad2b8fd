#pragma once

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// Says for every name what it stands for, and for every expression its type: fills what is the resolver's
/// in syntax.hpp, of the application and of its libraries. What a controller refuses (undefined names, wrong
/// types, missing arguments, values where a place is needed ...) is found.
void resolve(Application& application, Findings& findings);

}  // namespace val3
