#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// Larger than any configuration file has reason to be.
inline constexpr std::size_t kConfigFileSizeMax = 1U << 20U;

/// The whole file, or a ConfigError: not there, a folder, not readable, empty, larger than `size_max_bytes`.
std::string read_file_bytes(const std::filesystem::path& file, std::size_t size_max_bytes);

/// The file as strict JSON, at most kConfigFileSizeMax; see parse_strict_json().
nlohmann::json read_json_file(const std::filesystem::path& file);

}  // namespace cell
