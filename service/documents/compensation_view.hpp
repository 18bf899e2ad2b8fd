#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell.hpp"
#include "config/targets_file.hpp"
#include "service/documents/check_warmth.hpp"
#include "service/documents/compensation_document.hpp"
#include "service/run/straight_line_targets.hpp"

namespace cell {

/// SHA-256, lower-case hexadecimal, over an arm's file: its JSON with sorted keys and without white space,
/// followed by a line feed, as configuration_digest() has it of a cell's files. The layout does not matter,
/// every figure does. `source`: how messages call the bytes. ConfigError when they are no JSON.
std::string arm_digest(const std::string& source, std::string_view bytes);

/// Of targets of version 1: one result a target, in the same order. `warmth`: with which the arm was grown().
CompensationDocument compensation_of(const Cell& cell, const std::vector<Target>& targets,
                                     const std::vector<calib::CompensatedTarget>& results,
                                     const std::string& model, const std::optional<CheckWarmth>& warmth = {});
/// Of targets of version 2, with the points of their straight lines.
CompensationDocument compensation_of(const Cell& cell, const std::vector<PathTarget>& path,
                                     const std::string& model, const std::optional<CheckWarmth>& warmth = {});

}  // namespace cell
