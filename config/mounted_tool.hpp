#pragma once

#include <string>

#include "config/cell.hpp"
#include "config/truth.hpp"

namespace cell {

/// The cell with one of its tools on the arm in place of the probe: frame 7 is the tool's, its tip is what
/// touches. Nothing is known of its bodies, so that nothing may be moved by this cell: a person does. The
/// name is among tool_tips; std::logic_error where it is not.
Cell with_tool_mounted(const Cell& cell, const std::string& tool);

/// Why a tool cannot touch, with what can; for a name that is not among tool_tips.
std::string why_no_tip(const Cell& cell, const std::string& tool);

/// What the simulated cell hides then: the errors of frame 7 are those of the tool against its drawing, and
/// nothing of the probe is left. `tip`: of that tool.
Truth with_tip_mounted(const Truth& truth, const TouchingTip& tip);

}  // namespace cell
