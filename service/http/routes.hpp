#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/http/tokens.hpp"

namespace cell {

class Operation;
struct Services;

/// What stands behind the question mark; a name that is given twice is there twice.
using Query = std::multimap<std::string, std::string>;

/// A request as routes see it: parsed, bounded, no sockets.
struct HttpRequest {
  std::string method;  // "GET"
  std::string path;    // "/api/v1/runs/7", without the query, percent-encoded
  Query query;
  std::optional<std::string> authorization;
  std::optional<std::string> content_type;
  std::optional<std::string> idempotency_key;
  std::optional<std::string> if_none_match;
  std::optional<std::string> last_event_id;
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

/// RFC 9457: what every refusal looks like. `pointer` names the place in a body that is at fault, `parameter`
/// the query parameter.
struct Problem {
  unsigned status = 400;
  std::string_view kind;  // last part of the type: "urn:touchcal:problem:KIND"
  std::string detail;
  std::optional<std::string> pointer;
  std::vector<std::pair<std::string, std::string>> errors;  // code and detail of each unmet precondition
  std::vector<std::string> exits;                           // commands that the state allows
  std::optional<std::string> parameter;
};

HttpResponse to_response(const Problem& problem);

/// A target as it stands in the request line, taken apart, and its query percent-decoded; a plus sign stays
/// one. The path stays encoded, so that an encoded slash does not split a segment. Nothing when the target is
/// not an absolute path, is malformed (RFC 3986), or contains a control character, as it stands or encoded.
std::optional<std::pair<std::string, Query>> parse_target(std::string_view target);

/// One segment of such a path, percent-decoded.
std::string decode_segment(std::string_view segment);

/// Version 1 of the API (contract.md, section 4), as far as it can be answered at once: route_table.hpp. What
/// waits (Pace) is answered by api.hpp.
HttpResponse route(const HttpRequest& request, Services& services);
/// The same with services of its own.
HttpResponse route(const HttpRequest& request, Operation& operation, const Tokens& tokens);

}  // namespace cell
