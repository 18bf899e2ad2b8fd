#include "service/http/server/internal/response_text.hpp"

#include <algorithm>
// Boost's string_view, in status.hpp, needs std::ostream before it.
// clang-format off
#include <ostream>
#include <boost/beast/http/status.hpp>
// clang-format on

namespace cell {
namespace {

constexpr std::string_view kEveryAnswer =
    "\r\nServer: touchcald\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n";

/// Of all but the page, which has its own.
constexpr std::string_view kOfTheApi =
    "Cache-Control: no-store\r\n"
    "Content-Security-Policy: default-src 'none'; frame-ancestors 'none'\r\n";

std::string_view reason_of(unsigned status) {
  const auto reason = boost::beast::http::obsolete_reason(static_cast<boost::beast::http::status>(status));
  return {reason.data(), reason.size()};
}

}  // namespace

std::string response_text(const HttpResponse& response, unsigned minor, bool keep_alive, bool head) {
  const bool has_body = response.status != 304 && response.status != 204;
  const bool is_stream = response.content_type == "text/event-stream";
  std::string text;
  text.reserve(512 + response.body.size());
  text += minor == 0 ? "HTTP/1.0 " : "HTTP/1.1 ";
  text += std::to_string(response.status);
  text += ' ';
  text += reason_of(response.status);
  text += kEveryAnswer;
  const bool has_own_caching = std::ranges::any_of(
      response.headers, [](const auto& header) { return header.first == "Cache-Control"; });
  if (!has_own_caching) text += kOfTheApi;
  for (const auto& [name, value] : response.headers) {
    text += name;
    text += ": ";
    text += value;
    text += "\r\n";
  }
  if (keep_alive != (minor > 0)) text += keep_alive ? "Connection: keep-alive\r\n" : "Connection: close\r\n";
  if (has_body) {
    text += "Content-Type: ";
    text += response.content_type;
    text += "\r\n";
    if (!is_stream) {
      text += "Content-Length: ";
      text += std::to_string(response.body.size());
      text += "\r\n";
    }
  }
  text += "\r\n";
  if (has_body && !head) text += response.body;
  return text;
}

}  // namespace cell
