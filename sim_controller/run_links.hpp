#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sim_controller/run_script.hpp"
#include "sim_controller/val3/program/application.hpp"
#include "sim_controller/val3_signals.hpp"

namespace sim {

/// The inputs and outputs that a run can speak of, by link as signal_name() writes it: those that data of the
/// application and of its libraries are linked to, those of its library io, and those of the cell
/// (touchcal_links).
struct RunLinks {
  std::set<std::string> digital;
  std::set<std::string> analogue;
  std::vector<std::string> not_there;  // data linked to a card that is not there: which, where, the remedy
};

/// `cards`: what the script declares.
RunLinks links_of(const val3::Application& application, const CardNames& cards);

/// The cards of a script.
CardNames cards_of(std::span<const ScriptStep> steps);

/// The first line that names no input or output, with the names that there are; nothing when all do.
std::optional<ScriptError> unknown_signal(std::span<const ScriptStep> steps, const RunLinks& links);

}  // namespace sim
