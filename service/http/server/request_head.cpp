#include "service/http/server/request_head.hpp"

#include <algorithm>

#include "service/http/server/ends.hpp"
#include "service/http/server/request_handler.hpp"
#include "service/http/server/target.hpp"

namespace cell {
namespace {

bool same_text(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::optional<Problem> find_host_fault(const RequestHead& head, const Ends& ends) {
  const auto hosts = head.count("Host");
  if (hosts > 1 || (hosts == 0 && head.version >= 11))
    return Problem{.kind = ProblemKind::kHost, .detail = "exactly one Host is required"};
  if (hosts == 1 && !ends.is_our_host(*head.field("Host"))) {
    return Problem{.status = 421,
                   .kind = ProblemKind::kHost,
                   .detail = "unknown Host; touchcald --host-name NAME[:PORT] adds one"};
  }
  return std::nullopt;
}

std::optional<Problem> find_length_fault(const RequestHead& head) {
  const auto codings = head.count("Transfer-Encoding");
  if (codings > 0 &&
      (head.version < 11 || codings > 1 || !same_text(*head.field("Transfer-Encoding"), "chunked"))) {
    return Problem{.status = 501,
                   .kind = ProblemKind::kTransferEncoding,
                   .detail = "the only transfer encoding is chunked"};
  }
  const std::string length = head.field("Content-Length").value_or("");
  if (head.count("Content-Length") > 1 || length.find_first_not_of("0123456789") != std::string::npos)
    return Problem{.kind = ProblemKind::kContentLength, .detail = "Content-Length must be one number"};
  return std::nullopt;
}

/// The path and the query; nothing if they are malformed.
std::optional<std::pair<std::string, Query>> target_of(const RequestHead& head,
                                                       const RequestHandler& handler) {
  const std::string_view target = head.target;
  if (auto parsed = parse_target(target)) return parsed;
  auto path = parse_target(target.substr(0, target.find('?')));
  const bool is_taken = path && handler.ignores_query(head.method, path->first);
  return is_taken ? std::move(path) : std::nullopt;
}

Problem bad_target(std::string_view target) {
  return {.kind = ProblemKind::kTarget,
          .detail =
              target.starts_with('/')
                  ? "the target is malformed (RFC 3986): a % takes two hexadecimal digits after it, control "
                    "characters are not allowed, and [ ] { } | \" < > # and spaces are percent-encoded"
                  : "the target must be a path"};
}

}  // namespace

std::size_t RequestHead::count(std::string_view name) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(fields, [&](const auto& field) { return same_text(field.first, name); }));
}

std::optional<std::string> RequestHead::field(std::string_view name) const {
  const auto found =
      std::ranges::find_if(fields, [&](const auto& field) { return same_text(field.first, name); });
  return found == fields.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::string> RequestHead::list_field(std::string_view name) const {
  std::optional<std::string> joined;
  for (const auto& [own, value] : fields) {
    if (same_text(own, name)) joined = joined ? *joined + ", " + value : value;
  }
  return joined;
}

std::string RequestHead::route_method() const { return is_head() || method.empty() ? "GET" : method; }

std::optional<Problem> find_http_fault(const RequestHead& head, const Ends& ends) {
  if (head.bytes.find("\r\n ") != std::string::npos || head.bytes.find("\r\n\t") != std::string::npos)
    return Problem{.kind = ProblemKind::kHttp, .detail = "a header field must be on one line"};
  if (auto problem = find_host_fault(head, ends)) return problem;
  if (auto problem = find_length_fault(head)) return problem;
  for (const char* once : {"Authorization", "Content-Type", "Idempotency-Key", "Origin"}) {
    if (head.count(once) > 1)
      return Problem{.kind = ProblemKind::kHttp, .detail = std::string(once) + " is given twice"};
  }
  if (const auto origin = head.field("Origin"); origin && !ends.is_our_origin(*origin)) {
    return Problem{
        .status = 403, .kind = ProblemKind::kOrigin, .detail = "requests from other origins are refused"};
  }
  return std::nullopt;
}

std::variant<HttpRequest, Problem> to_request(const RequestHead& head, const Ends& ends,
                                              const RequestHandler& handler) {
  auto target = target_of(head, handler);
  if (!target) return bad_target(head.target);
  const std::string length = head.field("Content-Length").value_or("");
  return HttpRequest{.method = head.route_method(),
                     .path = std::move(target->first),
                     .query = std::move(target->second),
                     .authorization = head.field("Authorization"),
                     .content_type = head.field("Content-Type"),
                     .idempotency_key = head.field("Idempotency-Key"),
                     .if_none_match = head.list_field("If-None-Match"),
                     .last_event_id = head.field("Last-Event-ID"),
                     .announces_body = head.is_chunked || length.find_first_not_of('0') != std::string::npos,
                     .from_loopback = ends.from_loopback(),
                     .remote = ends.remote()};
}

}  // namespace cell
