#pragma once

#include <filesystem>
#include <string_view>

#include "config/cell.hpp"

namespace cell {

inline constexpr std::string_view kBlockSchema = "touchcal/block/4";
inline constexpr std::string_view kThirdBlockSchema = "touchcal/block/3";   // without places
inline constexpr std::string_view kSecondBlockSchema = "touchcal/block/2";  // without serial
inline constexpr std::string_view kFirstBlockSchema = "touchcal/block/1";   // without temperature_at

/// What a block's temperature may be, degrees C.
inline constexpr double kBlockTemperatureMinC = -50.0;
inline constexpr double kBlockTemperatureMaxC = 100.0;
/// Largest standard deviation of it, K.
inline constexpr double kBlockTemperatureStdMaxK = 100.0;

/// How far a unit vector may be from unit length, and two directions from being perpendicular or parallel.
inline constexpr double kDirectionErrorMax = 1e-6;
/// How far a face's centre may be from its plane.
inline constexpr double kFaceCenterErrorMaxMetres = 1e-6;

/// The artefact: faces in the order of their plane numbers, certified lengths, solids. ConfigError.
Block read_block(const std::filesystem::path& file);

}  // namespace cell
