#pragma once

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// Makes one of the types that are the same but for the place of their project: an application and its
/// libraries may find a type's project in several folders, of which one is a copy. Declarations get the index
/// of the first; user_types remains as it is.
void unify_types(Application& application);

}  // namespace val3
