#pragma once

#include <filesystem>
#include <string_view>

/// What a daemon keeps between its runs lies in one directory; the names of its files stand here only.
namespace cell {

inline constexpr std::string_view kStoreFile = "touchcal.sqlite";
inline constexpr std::string_view kOperateTokenFile = "operate.token";
inline constexpr std::string_view kViewTokenFile = "view.token";
inline constexpr std::string_view kBlockPoseFile = "place.json";
inline constexpr std::string_view kLockFile = "touchcald.lock";

/// $XDG_STATE_HOME/touchcal or ~/.local/state/touchcal.
std::filesystem::path default_state_directory();

}  // namespace cell
