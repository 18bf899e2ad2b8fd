#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace cell {

/// The two tokens of a daemon. Reading on loopback needs none.
struct Tokens {
  std::string operate;  // may operate and read
  std::string view;     // may read
};

/// `bytes` random bytes as hexadecimal text. Throws std::runtime_error if none are available.
std::string random_hex(std::size_t bytes);

/// Reads both tokens from the state directory, or creates them at the first start: 256 random bits in
/// hexadecimal, files of mode 0600; files with wider permissions are refused. Throws std::runtime_error that
/// names the file.
Tokens load_or_make_tokens(const std::filesystem::path& state_directory);

/// Compares in constant time, against timing attacks.
bool same_token(std::string_view expected, std::string_view presented);

}  // namespace cell
