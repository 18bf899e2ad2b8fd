#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/base/json_figures.hpp"
#include "service/run/status.hpp"

namespace cell {

/// What the cell looks like: the arm's frames, its and the probe's bodies, what stands around it. In R_-1,
/// bodies in the frame that they move with.
Json scene_json(const Cell& cell);

/// Where the arm is. `told`: the controller's newest state; nothing when it told none.
std::string joints_document(const std::optional<cs8::State>& told, const Status& status);

}  // namespace cell
