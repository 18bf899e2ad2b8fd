#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// How a run's touches are made.
enum class Touching { kAutomatic, kGuided };

/// What a result hangs on besides its touches: kept with every run. Nothing is unknown.
struct Conditions {
  std::optional<std::string> operator_name;
  std::optional<std::string> config_digest;           // configuration_digest() at the daemon's start
  std::optional<std::string> controller_application;  // as the controller told it, name and version
  std::optional<std::uint32_t> controller_session;    // tells one start of the controller from the next
  std::optional<Touching> touching;
  std::optional<LocatedPlace> place;  // where the block was located; nothing where its file has it
};

/// Why a run cannot be made at a known temperature, and what to do: the block's file does not say how warm
/// the block is. Nothing when all is well. Offline, where nobody can be asked, this is a warning.
std::optional<std::string> temperature_gap(const Cell& cell);

}  // namespace cell
