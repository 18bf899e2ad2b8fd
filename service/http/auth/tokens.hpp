#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "service/base/known_directory.hpp"
#include "service/http/auth/operator_tokens.hpp"
#include "service/http/auth/session.hpp"

namespace cell {

/// The tokens of a daemon. Reading on loopback needs none. An empty one is nobody's.
struct Tokens {
  std::string operate;                     // may operate and read; has no name
  std::string view;                        // may read
  std::vector<NamedToken> operators = {};  // may operate and read, and the audit names them
  std::vector<Session> sessions = {};      // of who has signed in, as they are now

  bool operator==(const Tokens&) const = default;
};

/// `bytes` random bytes as hexadecimal text. Throws std::runtime_error if none are available.
std::string random_hex(std::size_t bytes);

/// Reads the tokens from the state directory. The two without a name are created at the first start: 256
/// random bits in hexadecimal, files of mode 0600; files with wider permissions are refused. Throws
/// std::runtime_error that names the file.
Tokens load_or_make_tokens(const std::filesystem::path& state_directory);

/// The same for a daemon that is running, with the rules of operator_tokens_now() for all of them: `known` is
/// what was read last. A file without a name that has gone is made again, with another token. Where the whole
/// directory has gone, or another stands in its place, all are as before and nothing is made.
struct CurrentTokens {
  Tokens tokens;
  std::vector<std::string> troubles;
  std::vector<std::string> kept;
};
CurrentTokens tokens_now(const KnownDirectory& state_directory, const Tokens& known);

/// Compares in constant time, against timing attacks. An empty `expected` is the same as nothing.
bool same_token(std::string_view expected, std::string_view presented);

}  // namespace cell
