#include "service/http/server/response_text.hpp"

#include <algorithm>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/serializer.hpp>

namespace cell {

namespace http = boost::beast::http;

namespace {

/// Everything but the body, which the response has already.
http::response<http::empty_body> header_of(const HttpResponse& response, unsigned minor, bool keep_alive,
                                           bool has_body) {
  http::response<http::empty_body> header(static_cast<http::status>(response.status), minor == 0 ? 10 : 11);
  header.set(http::field::server, "touchcald");
  header.set("X-Content-Type-Options", "nosniff");
  header.set("Referrer-Policy", "no-referrer");
  const bool has_own_caching =  // as the page has
      std::ranges::any_of(response.headers, [](const auto& own) { return own.first == "Cache-Control"; });
  if (!has_own_caching) {
    header.set(http::field::cache_control, "no-store");
    header.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
  }
  for (const auto& [name, value] : response.headers) header.insert(name, value);
  header.keep_alive(keep_alive);
  if (!has_body) return header;
  header.set(http::field::content_type, response.content_type);
  if (response.content_type != "text/event-stream") header.content_length(response.body.size());
  return header;
}

}  // namespace

std::string response_text(const HttpResponse& response, unsigned minor, bool keep_alive, bool head) {
  const bool has_body = response.status != 304 && response.status != 204;
  const auto header = header_of(response, minor, keep_alive, has_body);
  http::response_serializer<http::empty_body> serializer(header);
  std::string text;
  text.reserve(512 + response.body.size());
  boost::system::error_code failure;
  serializer.next(failure, [&](boost::system::error_code&, const auto& buffers) {
    for (const auto buffer : boost::beast::buffers_range_ref(buffers))
      text.append(static_cast<const char*>(buffer.data()), buffer.size());
  });
  if (has_body && !head) text += response.body;
  return text;
}

}  // namespace cell
