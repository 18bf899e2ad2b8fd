#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/store/run_store.hpp"

/// What of a run outlives the daemon beside its touches, so that the next one can go on with it.
namespace cell {

/// A touch as it is commanded: what tells later whether a contact can belong to it, and where the arm may
/// stand when it was broken off.
struct CommandedTouch {
  calib::PlannedTouch touch;            // without its own way and times
  std::vector<calib::JointVector> way;  // from where the arm stood to the end of the search
};

/// As json text. Figures come back to the bit.
std::string command_text(const calib::PlannedTouch& touch, const std::vector<calib::JointVector>& way);
/// Nothing when the text is no command.
std::optional<CommandedTouch> command_from_text(const std::string& text);

/// Why a run that a daemon left open cannot be resumed in this cell, one sentence; nothing when it can.
/// `config_digest` is that of the cell's files now.
std::optional<std::string> why_not_resumable(const Cell& cell, const StoredRun& run,
                                             const std::optional<std::string>& config_digest);

}  // namespace cell
