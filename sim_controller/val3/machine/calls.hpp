#pragma once

#include "sim_controller/val3/machine/compiler.hpp"

namespace val3 {

/// A call of a program as an operation. NotSimulated where the program is of a library that is not there.
OperationPtr call_operation(Compiler& compiler, const Program& program, const Line& line);
/// The creation of a task that runs a program. At run time errors 29, 31, 32, 70.
OperationPtr creation_operation(Compiler& compiler, const Program& program, const Line& line);

}  // namespace val3
