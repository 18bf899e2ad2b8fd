#pragma once

namespace cell {

/// Set by CMake from the project's version.
inline constexpr const char* kVersion = TOUCHCAL_VERSION;

}  // namespace cell
