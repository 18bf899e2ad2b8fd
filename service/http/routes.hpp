#pragma once

#include <chrono>
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

/// A request as routes see it: parsed, bounded, no sockets.
struct HttpRequest {
  std::string method;  // "GET"
  std::string path;    // "/api/v1/runs/7", without the query
  std::map<std::string, std::string> query;
  std::optional<std::string> authorization;
  std::optional<std::string> content_type;
  std::optional<std::string> idempotency_key;
  std::optional<std::string> if_none_match;
  std::string body;
  bool from_loopback = false;
};

struct HttpResponse {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// RFC 9457: what every refusal looks like. `pointer` names the place in a body that is at fault.
struct Problem {
  unsigned status = 400;
  std::string_view kind;  // last part of the type: "urn:touchcal:problem:KIND"
  std::string detail;
  std::optional<std::string> pointer;
  std::vector<std::pair<std::string, std::string>> errors;  // code and detail of each unmet precondition
  std::vector<std::string> exits;                           // commands that the state allows
};

HttpResponse to_response(const Problem& problem);

/// A target as it stands in the request line, taken apart; nothing when it is not an absolute path.
std::optional<std::pair<std::string, std::map<std::string, std::string>>> parse_target(
    std::string_view target);

/// How long a request wants to wait for another status than the one it knows.
struct LongPoll {
  std::uint64_t after = 0;
  std::chrono::seconds wait{};
};
std::optional<LongPoll> long_poll(const HttpRequest& request);

/// The recipe that has to be planned (Operation::plan_recipe, seconds) before a POST plan can be answered;
/// nothing when it is not that, may not ask, has been planned, or must come again as another plan is under
/// way.
std::optional<std::string> recipe_to_plan(const HttpRequest& request, const Operation& operation,
                                          const Tokens& tokens);

struct RouteName {
  std::string_view method;
  std::string_view path;  // behind /api/v1/; * stands for any one segment
};
/// Everything version 1 answers to.
std::vector<RouteName> route_names();

/// Version 1 of the API (contract.md, section 4).
HttpResponse route(const HttpRequest& request, Operation& operation, const Tokens& tokens);

}  // namespace cell
