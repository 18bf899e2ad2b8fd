#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "service/store/schema.hpp"

namespace cell {

/// A request as an Idempotency-Key knows it again.
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
/// The key came with another request or body.
struct KeyOfAnother {};
/// The first request with this key has no answer yet.
struct KeyInProgress {};

using KeyLookUp = std::variant<KeyIsNew, StoredAnswer, KeyOfAnother, KeyInProgress>;

/// First answers by Idempotency-Key, kept for a day and across restarts. Throws what the database throws.
class AnswerStore {
 public:
  static constexpr int kKeptHours = 24;

  explicit AnswerStore(SharedDatabase database) : database_(std::move(database)) {}

  /// `oldest` is the time, as in format_utc(), before which answers are forgotten: kKeptHours ago.
  KeyLookUp take(const KeyedRequest& request, const std::string& oldest);
  /// The answer to the request that take() found to be new. Durable when this returns.
  void keep(const KeyedRequest& request, const StoredAnswer& answer, const std::string& now);
  /// There is no answer worth keeping: the key is free again.
  void give_up(const KeyedRequest& request) { in_progress_.erase(request.key); }

 private:
  SharedDatabase database_;
  std::set<std::string> in_progress_;
};

}  // namespace cell
