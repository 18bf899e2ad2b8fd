#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cell {

/// Random bytes in a token, which is written in hexadecimal.
inline constexpr std::size_t kTokenBytes = 32;

/// A longer one fits into no header of a request beside what else stands there.
inline constexpr std::size_t kTokenCharactersMax = 1024;

/// How to replace a token that the daemon makes.
inline constexpr std::string_view kMadeAtStart = "remove the file to have a new token made";

/// The token in this file; nothing if there is no such file. Throws std::runtime_error that names the file if
/// its permissions are too wide, it cannot be read or it holds no token: fewer characters than one has, more
/// than kTokenCharactersMax, or others than visible ones of ASCII. `replacement` is the remedy that the error
/// tells.
std::optional<std::string> read_token(const std::filesystem::path& file,
                                      std::string_view replacement = kMadeAtStart);

}  // namespace cell
