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

/// Joint vectors in the 10^-6 degrees of the wire, and back.
cs8::JointsMicrodeg to_wire(const calib::JointVector& joints);
calib::JointVector from_wire(const cs8::JointsMicrodeg& joints);

/// The guarded-touch command of a planned touch, reached through `via`.
cs8::Touch touch_command(const Cell& cell, const calib::PlannedTouch& planned,
                         const std::vector<calib::JointVector>& via);

/// Joint moves through `via` to `target`.
cs8::Travel travel_command(const Cell& cell, const calib::JointVector& target,
                           const std::vector<calib::JointVector>& via);

cs8::Retract retract_command(const Cell& cell);

/// Effect of an outcome on the run: none (a contact, or a requested stop), a fault that holds it (a person
/// can remove the reason and repeat the touch) or one that ends it.
struct OutcomeFault {
  Fault fault;
  bool holds = false;
  bool suspends = false;  // the run continues by itself once the reason is gone

  [[nodiscard]] Event event() const {
    return suspends ? Event::kSuspendFault : holds ? Event::kHoldFault : Event::kAbortFault;
  }
};
std::optional<OutcomeFault> fault_of(cs8::Outcome outcome, cs8::Phase phase, std::int32_t error_number);

/// The same for a refused command: it holds the run if a person at the cell can remove the reason.
OutcomeFault fault_of(const cs8::Rejected& rejected);

/// Largest distance between the two contacts of one touch, the first at search speed, for an arm with a
/// repeatability of 0.03 mm.
inline constexpr double kContactSpreadMaxMetres = 1e-4;

/// Why a reported contact cannot be the commanded one; nothing if it can. The ball of the nominal model must
/// lie on the line from the approach posture to the end of the search, in both contacts if there are two.
std::optional<std::string> implausibility_reason(const Cell& cell, const calib::PlannedTouch& planned,
                                                 const cs8::TouchResult& result);

}  // namespace cell
