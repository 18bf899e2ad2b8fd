#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"

namespace cell {

/// A touch as it is commanded: what tells later whether a contact can belong to it, and where the arm may
/// stand when it was broken off.
struct CommandedTouch {
  calib::PlannedTouch touch;             // without its own path and times
  std::vector<calib::JointVector> path;  // from where the arm stood to the end of the search
};

/// As json text. Figures come back to the bit.
std::string command_text(const calib::PlannedTouch& touch, const std::vector<calib::JointVector>& path);
/// Nothing when the text is no command.
std::optional<CommandedTouch> command_from_text(const std::string& text);

}  // namespace cell
