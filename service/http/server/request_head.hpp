#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "service/http/server/http_message.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

class Ends;
class RequestHandler;

/// The request line and the header fields as they were parsed, before anything is concluded from them.
struct RequestHead {
  std::string method;
  std::string target;
  unsigned version = 11;  // 10 is HTTP/1.0
  bool is_chunked = false;
  std::vector<std::pair<std::string, std::string>> fields;  // in their order, a name may be there twice
  std::string bytes;                                        // which still show folded lines

  [[nodiscard]] std::size_t count(std::string_view name) const;
  /// The first one of that name; names differ by more than their case.
  [[nodiscard]] std::optional<std::string> field(std::string_view name) const;
  /// All lines of a field that is a list (RFC 9110, 5.3).
  [[nodiscard]] std::optional<std::string> list_field(std::string_view name) const;
  [[nodiscard]] bool is_head() const { return method == "HEAD"; }
  /// As routes see it: a HEAD is handled as a GET.
  [[nodiscard]] std::string route_method() const;
};

/// What a parser accepts although RFC 9110 and 9112 forbid it, or what this daemon refuses by a field.
std::optional<Problem> find_http_fault(const RequestHead& head, const Ends& ends);

/// The request without its body, or what is wrong with its target. A stop is taken even with a malformed
/// query.
std::variant<HttpRequest, Problem> to_request(const RequestHead& head, const Ends& ends,
                                              const RequestHandler& handler);

}  // namespace cell
