#pragma once

#include "cs8_protocol/client.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// A fault of the link ends by itself when there is a link again.
bool is_link_fault(FaultCode code);

/// A failure of the link as a fault.
Fault link_fault(const cs8::LinkError& error);

}  // namespace cell
