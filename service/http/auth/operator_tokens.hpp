#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace cell {

/// An operate token of somebody: the audit tells its name with each command.
struct NamedToken {
  std::string name;
  std::string token;

  bool operator==(const NamedToken&) const = default;
};

/// Bounds of what the directory `operators` of a state directory holds.
inline constexpr std::size_t kOperatorTokensMax = 32;
inline constexpr std::size_t kTokenNameBytesMax = 32;

/// The operate tokens with a name, by name: each is in a file of its name (letters, digits, '-' and '_') in
/// the directory `operators` of the state directory, which need not be there. The daemon makes none. Throws
/// std::runtime_error that names the place and the remedy for a directory that others may write in, a name or
/// a number out of bounds, a file that read_token() refuses, and a token that another file holds too, also
/// operate.token and view.token.
std::vector<NamedToken> read_operator_tokens(const std::filesystem::path& state_directory);

/// The same for a daemon that is running: what is refused does not count, also all that is in a directory
/// that others may write in. What cannot be read now, a file or the directory, is as in `known`, what was
/// read last: a disk that fails once takes no token from anybody.
struct CurrentOperators {
  std::vector<NamedToken> tokens;
  std::vector<std::string> troubles;  // a line for what does not count
  std::vector<std::string> kept;      // and for what is as it was read last
};
CurrentOperators operator_tokens_now(const std::filesystem::path& state_directory,
                                     const std::vector<NamedToken>& known = {});

}  // namespace cell
