#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// What identifies a repeated request.
struct KeyedRequest {
  std::string key;
  std::string request;      // method and path: "POST /api/v1/runs"
  std::string body_digest;  // sha256_hex(body)
};

struct StoredAnswer {
  unsigned status = 0;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;
};

/// The key is new: the caller answers, then calls keep() or give_up().
struct KeyIsNew {};
/// The key was used with another request or body.
struct KeyReused {};
/// The first request with this key is still being answered.
struct KeyInProgress {};

using KeyLookUp = std::variant<KeyIsNew, StoredAnswer, KeyReused, KeyInProgress>;

/// First answers by Idempotency-Key, kept for a day, also across restarts. Throws what the database throws,
/// and DamagedStore for a row that is not as it was written.
class AnswerStore {
 public:
  static constexpr int kKeptHours = 24;

  explicit AnswerStore(SharedDatabase database) : database_(std::move(database)) {}

  /// `oldest`, as in format_utc(): earlier answers are deleted, those before the last kKeptHours.
  KeyLookUp take(const KeyedRequest& request, const std::string& oldest);
  /// Stores the answer to a request that take() found to be new. Durable on return.
  void keep(const KeyedRequest& request, const StoredAnswer& answer, const std::string& now);
  /// Releases the key without an answer.
  void give_up(const KeyedRequest& request) { in_progress_.erase(request.key); }

 private:
  void forget_before(const std::string& oldest);

  SharedDatabase database_;
  std::set<std::string> in_progress_;
};

}  // namespace cell
