#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace cell {

/// Of random numbers in a token; it is written in hexadecimal.
inline constexpr std::size_t kTokenBytes = 32;

/// The token in this file; nothing when there is no such file. Throws std::runtime_error that names the file
/// when others than its owner may use it, it cannot be read or it holds no token.
std::optional<std::string> read_token(const std::filesystem::path& file);

}  // namespace cell
