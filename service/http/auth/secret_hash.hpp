#pragma once

#include <cstddef>
#include <string>

namespace cell {

/// What one hash takes, while it is made or compared.
inline constexpr std::size_t kHashMemoryBytes = std::size_t{64} * 1024 * 1024;

/// The secret as Argon2id text with its salt and its costs (RFC 9106), by libsodium: kHashMemoryBytes and
/// some tenths of a second, so that a stolen file does not give short secrets away at once. Call it where
/// nothing waits. Throws std::bad_alloc where there is no memory for it.
std::string hash_secret(const std::string& secret);

/// Whether the hash is of this secret. A text that is no hash is of none. Throws std::bad_alloc where there
/// is no memory to tell.
bool is_secret_of(const std::string& hash, const std::string& secret);

/// Whether a text can be a hash of hash_secret(): of these costs, as one of others could ask for any amount
/// of memory.
bool is_secret_hash(const std::string& text);

/// A hash that is of no secret: a name that is not known takes as long as one that is.
const std::string& hash_of_nobody();

}  // namespace cell
