#pragma once

#include "sim_controller/val3/machine/compiler.hpp"

namespace val3 {

/// `place = ... = place = value` as an operation: one value to all places, the last one first. Each place is
/// written as its own type wants: a variable is set, an output and a channel are written. NotSimulated for
/// places whose types do not take one and the same value.
OperationPtr assignment_operation(Compiler& compiler, const Line& line);

}  // namespace val3
