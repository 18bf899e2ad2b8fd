#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"

namespace cell {

/// A commanded touch, kept to judge later whether a contact can belong to it and where the arm may be after
/// an interruption.
struct CommandedTouch {
  calib::PlannedTouch touch;             // without its own path and times
  std::vector<calib::JointVector> path;  // from where the arm stood to the end of the search
};

/// As JSON text, from which every figure is read back bit by bit.
std::string command_text(const calib::PlannedTouch& touch, const std::vector<calib::JointVector>& path);
/// Empty when the text is not a command.
std::optional<CommandedTouch> command_from_text(const std::string& text);

}  // namespace cell
