#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/located_place.hpp"

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

/// SHA-256 in lower-case hex over the files a cell was read from (Cell::files), in that order: of each the
/// JSON with sorted keys and without white space, ended by a line feed. Another layout of a file is the same
/// digest, another figure is not. Nothing for a cell that was not read from files. Throws ConfigError when
/// one cannot be read any more.
std::optional<std::string> configuration_digest(const Cell& cell);

/// Why a run cannot be made at a known temperature, and what to do: the block's file does not say how warm
/// the block is. Nothing when all is well. Offline, where nobody can be asked, this is a warning.
std::optional<std::string> temperature_gap(const Cell& cell);

/// `conditions` of a run and of a result: temperatures, certificates, versions, operator, digest; null where
/// unknown.
nlohmann::ordered_json conditions_json(const Cell& cell, const Conditions& conditions);
/// The same as text: what is kept with a run.
std::string conditions_document(const Cell& cell, const Conditions& conditions);

/// Whether a person made the touches of a run that kept these conditions; false when they do not say.
bool is_guided(const std::optional<std::string>& conditions);

}  // namespace cell
