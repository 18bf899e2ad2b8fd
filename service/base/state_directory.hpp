#pragma once

#include <filesystem>
#include <string_view>

/// The state directory: what a daemon keeps on disk. The names of its files are defined here only.
namespace cell {

inline constexpr std::string_view kStoreFile = "touchcal.sqlite";
inline constexpr std::string_view kBegunFile = "touchcal.begun";  // beside a database since its creation
inline constexpr std::string_view kOperateTokenFile = "operate.token";
inline constexpr std::string_view kViewTokenFile = "view.token";
inline constexpr std::string_view kOperatorsDirectory = "operators";  // a file for each named token
inline constexpr std::string_view kUserFile = "users.json";           // who may sign in, and who has
inline constexpr std::string_view kBlockPoseFile = "place.json";
inline constexpr std::string_view kLocatingFile = "locating.json";  // of a dialogue that is under way
inline constexpr std::string_view kSocketFile = "touchcald.sock";
inline constexpr std::string_view kLockFile = "touchcald.lock";

/// $XDG_STATE_HOME/touchcal or ~/.local/state/touchcal.
std::filesystem::path default_state_directory();

/// The directory itself, or its nearest parent that exists. Throws std::runtime_error, with the remedy, where
/// that is no directory, and for a link on the way to what is not there.
std::filesystem::path demand_state_directory(const std::filesystem::path& directory);

/// Throws std::runtime_error, with the remedy, for a directory that others than its owner may write in: they
/// could put tokens and a database there. Nothing is demanded of one that is not there yet.
void demand_closed_directory(const std::filesystem::path& directory);

/// The same for one of another owner than this process; root's is taken as well.
void demand_own_directory(const std::filesystem::path& directory);

}  // namespace cell
