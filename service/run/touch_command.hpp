#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/run/fault_table.hpp"
#include "service/run/packml_state.hpp"

namespace cell {

/// Joint vectors in the wire's 10^-6 degrees, and back.
cs8::JointsMicrodeg to_wire(const calib::JointVector& joints);
calib::JointVector from_wire(const cs8::JointsMicrodeg& joints);

/// The guarded touch that makes a planned touch, reached through `via`.
cs8::Touch touch_command(const Cell& cell, const calib::PlannedTouch& planned,
                         const std::vector<calib::JointVector>& via);

/// Joint moves through `via` to `target`.
cs8::Travel travel_command(const Cell& cell, const calib::JointVector& target,
                           const std::vector<calib::JointVector>& via);

cs8::Retract retract_command(const Cell& cell);

/// What the run makes of an outcome: nothing (a contact, or a stop that was asked for), a fault to hold on (a
/// person can mend it and try the touch again) or one that ends the run.
struct OutcomeFault {
  Fault fault;
  bool holds = false;
  bool suspends = false;  // the run goes on by itself once the reason is gone

  [[nodiscard]] Event event() const {
    return suspends ? Event::kSuspendFault : holds ? Event::kHoldFault : Event::kAbortFault;
  }
};
std::optional<OutcomeFault> fault_of(cs8::Outcome outcome, cs8::Phase phase, std::int32_t error_number);

/// The same of a command that was refused: it holds when a person at the cell can remove the reason.
OutcomeFault fault_of(const cs8::Rejected& rejected);

/// Two contacts of one touch by an arm that repeats to 0.03 mm, the first at search speed, lie no farther
/// apart.
inline constexpr double kContactSpreadMaxMetres = 1e-4;

/// Why a reported contact cannot be the one that was commanded, or nothing: the nominal model's ball must be
/// on the line from the approach posture to the search's end; where a second touch is made, both are.
std::optional<std::string> implausible(const Cell& cell, const calib::PlannedTouch& planned,
                                       const cs8::TouchResult& result);

}  // namespace cell
