#pragma once

#include <optional>
#include <string>

#include "config/fault_file.hpp"
#include "sim_controller/cabinet.hpp"

namespace sim {

/// No jog is faster: a robot in manual mode.
inline constexpr double kJogSpeedMaxMetresPerSecond = 0.25;

/// A person jogs with the pendant: joints, or the nominal tool centre in a straight line. A trip of the probe
/// stops the arm, unless the order says otherwise, as the person would. Ball and bodies meet what is there.
/// Nothing once it is begun; else why the pendant does not do it: not in manual mode, no power, an emergency
/// stop, the arm moves, a target that cannot be reached.
std::optional<std::string> begin_jog(const Plant& plant, Cabinet& cabinet, const cell::JogOrder& order);

}  // namespace sim
