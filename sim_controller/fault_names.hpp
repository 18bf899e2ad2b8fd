#pragma once

#include <string>
#include <vector>

#include "config/fault_file.hpp"
#include "sim_controller/fault_plan.hpp"

namespace sim {

/// The fault that was meant. ConfigError at the key that names no fault, message or phase, that this fault
/// has no use for, or that it misses.
PlannedFault planned(const cell::DeclaredFault& declared);
std::vector<PlannedFault> planned(const std::vector<cell::DeclaredFault>& declared);

/// Every name a fault may have.
std::vector<std::string> fault_names();

}  // namespace sim
