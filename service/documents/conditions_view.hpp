#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {

/// `conditions` of a run and of a result: temperatures, certificates, versions, operator, digest; unknown
/// ones are null.
ConditionsDocument conditions_of(const Cell& cell, const RunConditions& conditions);
/// The same as text, as stored with a run.
std::string conditions_document(const Cell& cell, const RunConditions& conditions);

/// True if these stored conditions say that a person made the touches.
bool is_guided(const std::optional<std::string>& conditions);
/// True if these stored conditions name a place where the block was found; false for what is no json.
bool names_place(const std::optional<std::string>& conditions);
/// Where the block stood by these stored conditions: R_-1 then, in R_-1 of the cell's file. That of the file
/// where they name no place.
Eigen::Isometry3d block_stood_at(const std::optional<std::string>& conditions);
/// What a qualification before the run measured of the noise of a touch, by these stored conditions.
std::optional<calib::TouchNoise> qualified_noise(const std::optional<std::string>& conditions);
/// The tool that touched in place of the probe, by these stored conditions.
std::optional<std::string> touching_tool(const std::optional<std::string>& conditions);
/// True if the block stood at `place` by these stored conditions: the same location, or that of the cell's
/// file. Conditions of an older daemon, which name none, are those of the file.
bool stood_at(const std::optional<std::string>& conditions, const std::optional<BlockPose>& place);

}  // namespace cell
