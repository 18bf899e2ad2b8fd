#include "service/http/auth/secret_hash.hpp"

#include <sodium.h>

#include <array>
#include <new>
#include <stdexcept>

#include "service/http/auth/token_file.hpp"
#include "service/http/auth/tokens.hpp"

namespace cell {
namespace {

/// The library's own choice of what somebody waits for.
constexpr unsigned long long kOperations = crypto_pwhash_OPSLIMIT_INTERACTIVE;
constexpr std::size_t kMemoryBytes = crypto_pwhash_MEMLIMIT_INTERACTIVE;

/// As often as one likes, from any thread.
void demand_sodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be used: it finds no random numbers");
}

}  // namespace

std::string hash_secret(const std::string& secret) {
  demand_sodium();
  std::array<char, crypto_pwhash_STRBYTES> text{};
  if (crypto_pwhash_str(text.data(), secret.data(), secret.size(), kOperations, kMemoryBytes) != 0)
    throw std::bad_alloc();
  return text.data();
}

bool is_secret_of(const std::string& hash, const std::string& secret) {
  demand_sodium();
  return is_secret_hash(hash) && crypto_pwhash_str_verify(hash.c_str(), secret.data(), secret.size()) == 0;
}

bool is_secret_hash(const std::string& text) {
  // Also tells costs apart: a hash of other ones could ask for any amount of memory.
  return text.size() < crypto_pwhash_STRBYTES && text.find('\0') == std::string::npos &&
         crypto_pwhash_str_needs_rehash(text.c_str(), kOperations, kMemoryBytes) == 0;
}

const std::string& hash_of_nobody() {
  static const std::string hash = hash_secret(random_hex(kTokenBytes));
  return hash;
}

}  // namespace cell
