#pragma once

#include <filesystem>
#include <string_view>

#include "config/cell.hpp"

namespace cell {

inline constexpr std::string_view kBlockSchema = "touchcal/block/1";

/// How far a unit vector may be from unit length, and two directions from being perpendicular or parallel.
inline constexpr double kDirectionErrorMax = 1e-6;
/// How far a face's centre may be from its plane.
inline constexpr double kFaceCenterErrorMaxMetres = 1e-6;

/// The artefact: faces in the order of their plane numbers, certified lengths, solids. ConfigError.
Block read_block(const std::filesystem::path& file);

}  // namespace cell
