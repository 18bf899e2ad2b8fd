#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cell {

/// Random bytes in a token, which is written in hexadecimal.
inline constexpr std::size_t kTokenBytes = 32;

/// A longer one fits into no header of a request beside what else stands there.
inline constexpr std::size_t kTokenCharactersMax = 1024;

/// How to replace a token that the daemon makes.
inline constexpr std::string_view kMadeAtStart = "remove the file to have a new token made";

/// A file that is there and cannot be read now, of which nobody knows what it holds. Not one whose rights
/// keep this user from it.
class TokenUnreadable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that holds no token.
class NoToken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The token in this file; nothing if there is no such file. Throws TokenUnreadable if it cannot be read,
/// std::runtime_error if its permissions are too wide or its owner is neither this user, nor root, nor that
/// of the directory, and NoToken if it holds none, all of which name the file: fewer characters than one has,
/// more than kTokenCharactersMax, or others than visible ones of ASCII. `replacement` is the remedy that the
/// error tells.
std::optional<std::string> read_token(const std::filesystem::path& file,
                                      std::string_view replacement = kMadeAtStart);

}  // namespace cell
