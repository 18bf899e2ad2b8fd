#include "service/http/auth/secret_hash.hpp"

#include <sodium.h>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace cell {
namespace {

/// The library's own choice of what somebody waits for. Its next larger one (MODERATE) takes four times the
/// memory, and the daemon shares its machine with the robot's other programs.
constexpr unsigned long long kOperations = crypto_pwhash_argon2id_OPSLIMIT_INTERACTIVE;
constexpr std::size_t kMemoryBytes = crypto_pwhash_argon2id_MEMLIMIT_INTERACTIVE;
static_assert(
    kOperations == 2 && kMemoryBytes == kHashMemoryBytes,
    "the hashes in every users.json have these costs: let the old ones be read before others count");

constexpr std::string_view kCosts = "$argon2id$v=19$m=65536,t=2,p=1$";
constexpr int kBase64 = sodium_base64_VARIANT_ORIGINAL_NO_PADDING;

using Salt = std::array<unsigned char, crypto_pwhash_argon2id_SALTBYTES>;
using Digest = std::array<unsigned char, 32>;
struct HashParts {
  Salt salt{};
  Digest digest{};
};

/// As often as one likes, from any thread.
void demand_sodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be used: it finds no random numbers");
}

template <class Bytes>
bool decode(std::string_view text, Bytes& bytes) {
  std::size_t length = 0;
  return sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &length, nullptr,
                           kBase64) == 0 &&
         length == bytes.size();
}

std::optional<HashParts> parts_of(std::string_view text) {
  if (!text.starts_with(kCosts)) return std::nullopt;
  const std::string_view behind = text.substr(kCosts.size());
  const std::size_t dollar = behind.find('$');
  HashParts parts;
  if (dollar == std::string_view::npos || !decode(behind.substr(0, dollar), parts.salt) ||
      !decode(behind.substr(dollar + 1), parts.digest)) {
    return std::nullopt;
  }
  return parts;
}

template <class Bytes>
std::string encoded(const Bytes& bytes) {
  std::array<char, 64> text{};
  return sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kBase64);
}

}  // namespace

std::string hash_secret(const std::string& secret) {
  demand_sodium();
  std::array<char, crypto_pwhash_argon2id_STRBYTES> text{};
  if (crypto_pwhash_argon2id_str(text.data(), secret.data(), secret.size(), kOperations, kMemoryBytes) != 0)
    throw std::bad_alloc();
  return text.data();
}

bool is_secret_of(const std::string& hash, const std::string& secret) {
  demand_sodium();
  const auto parts = parts_of(hash);
  if (!parts) return false;
  // Not crypto_pwhash_str_verify(): it says "wrong" where it gets no memory.
  Digest digest{};
  if (crypto_pwhash_argon2id(digest.data(), digest.size(), secret.data(), secret.size(), parts->salt.data(),
                             kOperations, kMemoryBytes, crypto_pwhash_argon2id_ALG_ARGON2ID13) != 0)
    throw std::bad_alloc();
  return sodium_memcmp(digest.data(), parts->digest.data(), digest.size()) == 0;
}

bool is_secret_hash(const std::string& text) { return parts_of(text).has_value(); }

const std::string& hash_of_nobody() {
  static const std::string hash = [] {
    demand_sodium();
    HashParts parts;
    randombytes_buf(parts.salt.data(), parts.salt.size());
    randombytes_buf(parts.digest.data(), parts.digest.size());
    return fmt::format("{}{}${}", kCosts, encoded(parts.salt), encoded(parts.digest));
  }();
  return hash;
}

}  // namespace cell
