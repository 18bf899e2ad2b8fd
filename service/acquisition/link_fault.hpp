#pragma once

#include "cs8_protocol/client.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// A fault of the link ends by itself when there is a link again.
bool is_link_fault(FaultCode code);

/// Why a run of an earlier daemon stays on hold, beyond the daemon's start and its link: what a person does
/// about it is told until it is done.
bool explains_hold(const Fault& fault);

/// A failure of the link as a fault.
Fault link_fault(const cs8::LinkError& error);

}  // namespace cell
