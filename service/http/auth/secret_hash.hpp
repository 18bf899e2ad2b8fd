#pragma once

#include <string>

namespace cell {

/// The secret as Argon2id text with its salt and its costs (RFC 9106), by libsodium: 64 MiB and some tenths
/// of a second, so that a stolen file does not give short secrets away at once. Call it where nothing waits.
/// Throws std::bad_alloc where there is no memory for it.
std::string hash_secret(const std::string& secret);

/// Whether the hash is of this secret. A text that is no hash is of none.
bool is_secret_of(const std::string& hash, const std::string& secret);

/// Whether a text can be a hash of hash_secret().
bool is_secret_hash(const std::string& text);

/// The hash of a secret that nobody has: a name that is not known takes as long as one that is.
const std::string& hash_of_nobody();

}  // namespace cell
