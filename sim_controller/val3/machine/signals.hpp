#pragma once

#include "sim_controller/val3/machine/nodes.hpp"

namespace val3 {

/// RunFailure 123 for what is not linked, 122 for a write to an input.
bool read_signal(const Context& context, const Dio& signal);
void write_signal(const Context& context, const Dio& signal, bool on);
double read_analogue(const Context& context, const Aio& signal);
void write_analogue(const Context& context, const Aio& signal, double value);

}  // namespace val3
