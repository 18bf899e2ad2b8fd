#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace cell {

/// What a request may do. Reading needs a token only from beyond loopback.
struct Tokens {
  std::string operate;  // may change things, and read
  std::string view;     // may read
};

/// `bytes` random bytes as hexadecimal text. Throws std::runtime_error when there is no randomness.
std::string random_hex(std::size_t bytes);

/// Reads both tokens from the state directory, or makes them at the first start: 256 random bits as
/// hexadecimal text, the files for their owner only (mode 0600); files that others may use are refused.
/// Throws std::runtime_error that names the file.
Tokens load_or_make_tokens(const std::filesystem::path& state_directory);

/// Compares in constant time: how long it takes says nothing about how much was right.
bool same_token(std::string_view expected, std::string_view presented);

}  // namespace cell
