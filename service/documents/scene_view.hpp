#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/base/json_figures.hpp"
#include "service/run/status.hpp"

namespace cell {

/// The geometry of the cell: the arm's frames, the bodies of arm and probe, the solids around. In R_-1;
/// bodies in the frame that they move with.
Json scene_json(const Cell& cell);

/// The posture of the arm. `state`: the controller's newest state, if any.
std::string joints_document(const std::optional<cs8::State>& state, const Status& status);

}  // namespace cell
