#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cell {

/// Largest body of a request whose route allows no more.
inline constexpr std::size_t kBodyBytesMax = 64 * 1024;

/// The decoded query; a name given twice occurs twice.
using Query = std::multimap<std::string, std::string>;

/// A request as routes see it: parsed and bounded, without its socket.
struct HttpRequest {
  std::string method;  // "GET"
  std::string path;    // "/api/v1/runs/7", without the query, percent-encoded
  Query query;
  std::optional<std::string> authorization;
  std::optional<std::string> content_type;
  std::optional<std::string> idempotency_key;
  std::optional<std::string> if_none_match;
  std::optional<std::string> last_event_id;
  bool announces_body = false;  // by its header; the body itself may not be here yet
  std::string body;
  bool from_loopback = false;
  std::string remote;  // the client's address, for the audit
};

struct HttpResponse {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

}  // namespace cell
