#include "service/http/server/session.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <memory>
#include <utility>
#include <variant>

#include "service/http/server/request_handler.hpp"
#include "service/http/server/response_text.hpp"
#include "service/http/server/target.hpp"

namespace cell {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

constexpr std::size_t kReadBytes = 4096;

using Parser = http::request_parser<http::string_body>;
using Incoming = http::request<http::string_body>;
using PlainStream = beast::tcp_stream;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

std::optional<std::string> field(const Incoming& request, http::field name) {
  const auto found = request.find(name);
  return found == request.end() ? std::nullopt : std::optional<std::string>(found->value());
}

std::optional<std::string> field(const Incoming& request, beast::string_view name) {
  const auto found = request.find(name);
  return found == request.end() ? std::nullopt : std::optional<std::string>(found->value());
}

/// A list field may be repeated (RFC 9110, 5.3).
std::optional<std::string> list_field(const Incoming& request, http::field name) {
  std::optional<std::string> joined;
  const auto [first, last] = request.equal_range(name);
  for (auto line = first; line != last; ++line)
    joined = joined ? *joined + ", " + std::string(line->value()) : std::string(line->value());
  return joined;
}

/// The two ends of a connection and the accepted values of Host: another Host is a page that reached the
/// daemon under a name of its own (DNS rebinding).
struct Ends {
  bool from_loopback = false;
  std::string remote;
  std::string scheme;  // of an accepted Origin
  std::vector<std::string> hosts;

  Ends(const tcp::socket& socket, const char* own_scheme, const std::vector<std::string>& names)
      : scheme(own_scheme) {
    const tcp::endpoint client = socket.remote_endpoint();
    const tcp::endpoint own = socket.local_endpoint();
    from_loopback = client.address().is_loopback();
    remote = client.address().to_string();
    const std::string port = ":" + std::to_string(own.port());
    const std::string address = own.address().to_string();
    hosts = {"127.0.0.1" + port, "localhost" + port, "[::1]" + port,
             (own.address().is_v6() ? "[" + address + "]" : address) + port};
    for (const std::string& name : names) {
      hosts.push_back(name + port);
      hosts.push_back(name);  // at the scheme's own port, where a proxy listens
    }
  }

  [[nodiscard]] bool is_our_host(beast::string_view host) const {
    return std::ranges::any_of(hosts, [&](const std::string& own) { return beast::iequals(host, own); });
  }
  [[nodiscard]] bool is_our_origin(beast::string_view origin) const {
    return origin.starts_with(scheme) && is_our_host(origin.substr(scheme.size()));
  }
};

/// What Beast accepts although RFC 9110 and 9112 forbid it. `raw_header`: the bytes, which still show folded
/// lines.
std::optional<Problem> find_http_fault(const Incoming& request, std::string_view raw_header,
                                       const Ends& ends) {
  if (raw_header.find("\r\n ") != raw_header.npos || raw_header.find("\r\n\t") != raw_header.npos) {
    return Problem{.kind = ProblemKind::kHttp, .detail = "a header field must be on one line"};
  }
  const auto hosts = request.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && request.version() >= 11)) {
    return Problem{.kind = ProblemKind::kHost, .detail = "exactly one Host is required"};
  }
  if (hosts == 1 && !ends.is_our_host(request[http::field::host])) {
    return Problem{.status = 421,
                   .kind = ProblemKind::kHost,
                   .detail = "unknown Host; --host-name adds a name of the daemon"};
  }
  const auto codings = request.count(http::field::transfer_encoding);
  if (codings > 0 && (request.version() < 11 || codings > 1 ||
                      !beast::iequals(request[http::field::transfer_encoding], "chunked"))) {
    return Problem{.status = 501,
                   .kind = ProblemKind::kTransferEncoding,
                   .detail = "the only transfer encoding is chunked"};
  }
  if (request.count(http::field::content_length) > 1 ||
      request[http::field::content_length].find_first_not_of("0123456789") != beast::string_view::npos) {
    return Problem{.kind = ProblemKind::kContentLength, .detail = "Content-Length must be one number"};
  }
  for (const http::field once : {http::field::authorization, http::field::content_type}) {
    if (request.count(once) > 1)
      return Problem{.kind = ProblemKind::kHttp, .detail = "a field is given twice"};
  }
  if (request.count("Idempotency-Key") > 1)
    return Problem{.kind = ProblemKind::kHttp, .detail = "a field is given twice"};
  if (request.count(http::field::expect) > 0) {
    return Problem{.status = 417, .kind = ProblemKind::kExpect, .detail = "Expect is not supported"};
  }
  if (request.count(http::field::origin) > 0 && !ends.is_our_origin(request[http::field::origin])) {
    return Problem{
        .status = 403, .kind = ProblemKind::kOrigin, .detail = "requests from other origins are refused"};
  }
  return std::nullopt;
}

/// A HEAD is handled as a GET.
std::string method_of(const Incoming& request) {
  return request.method() == http::verb::head || request.method_string().empty()
             ? "GET"
             : std::string(request.method_string());
}

/// The parsed target. A stop is taken even with a malformed query.
std::optional<std::pair<std::string, Query>> target_of(const Incoming& incoming,
                                                       const RequestHandler& handler) {
  const std::string_view target = view(incoming.target());
  if (auto parsed = parse_target(target)) return parsed;
  auto path = parse_target(target.substr(0, target.find('?')));
  const bool is_taken = path && handler.ignores_query(view(incoming.method_string()), path->first);
  return is_taken ? std::move(path) : std::nullopt;
}

Problem bad_target(std::string_view target) {
  return {.kind = ProblemKind::kTarget,
          .detail =
              target.starts_with('/')
                  ? "the target is malformed (RFC 3986): a % takes two hexadecimal digits behind it, control "
                    "characters are not allowed, and [ ] { } | \" < > # and spaces are percent-encoded"
                  : "the target must be a path"};
}

std::optional<HttpRequest> to_request(Incoming& incoming, const Ends& ends, const RequestHandler& handler) {
  auto target = target_of(incoming, handler);
  if (!target) return std::nullopt;
  return HttpRequest{.method = method_of(incoming),
                     .path = std::move(target->first),
                     .query = std::move(target->second),
                     .authorization = field(incoming, http::field::authorization),
                     .content_type = field(incoming, http::field::content_type),
                     .idempotency_key = field(incoming, "Idempotency-Key"),
                     .if_none_match = list_field(incoming, http::field::if_none_match),
                     .last_event_id = field(incoming, "Last-Event-ID"),
                     .body = std::move(incoming.body()),
                     .from_loopback = ends.from_loopback,
                     .remote = ends.remote};
}

Problem too_large() {
  return {.status = 413, .kind = ProblemKind::kTooLarge, .detail = "the body is too large"};
}

/// The answer to bytes that are not a request; nothing if nobody can read one.
std::optional<Problem> problem_of(const boost::system::error_code& failure) {
  if (failure == http::error::body_limit) return too_large();
  if (failure == http::error::header_limit || failure == http::error::buffer_overflow) {
    return Problem{.status = 431, .kind = ProblemKind::kTooLarge, .detail = "the header is too large"};
  }
  if (failure == http::error::end_of_stream || failure == http::error::partial_message) return std::nullopt;
  if (failure.category() == http::make_error_code(http::error::bad_method).category()) {
    return Problem{.kind = ProblemKind::kHttp, .detail = "not an HTTP request: " + failure.message()};
  }
  return std::nullopt;  // a socket error
}

/// Largest body of this request.
std::uint64_t body_bytes_max(const Incoming& request, const RequestHandler& handler,
                             const HttpLimits& limits) {
  const auto target = target_of(request, handler);
  const std::size_t of_route =
      target ? handler.body_bytes_max(view(request.method_string()), target->first) : kBodyBytesMax;
  return of_route > kBodyBytesMax ? of_route : limits.body_bytes_max;
}

/// Serves the requests of a connection in order, with or without TLS.
template <class Stream>
class Session {
 public:
  Session(Stream stream, RequestHandler& handler, const HttpLimits& limits, Ends ends)
      : stream_(std::move(stream)),
        handler_(handler),
        limits_(limits),
        ends_(std::move(ends)),
        buffer_(limits.header_bytes_max + handler.largest_body_bytes()) {}

  asio::awaitable<void> serve();

 private:
  asio::awaitable<bool> serve_one();
  asio::awaitable<std::optional<Problem>> read_request(Parser& parser);
  asio::awaitable<std::variant<std::string, boost::system::error_code>> read_header(Parser& parser);
  asio::awaitable<void> read_some();
  asio::awaitable<void> write(const std::string& text);
  asio::awaitable<void> write_events(const HttpRequest& request);
  asio::awaitable<void> finish();
  void expires_after(std::chrono::seconds deadline) {
    beast::get_lowest_layer(stream_).expires_after(deadline);
  }

  Stream stream_;
  RequestHandler& handler_;
  HttpLimits limits_;
  Ends ends_;
  beast::flat_buffer buffer_;
};

template <class Stream>
asio::awaitable<void> Session<Stream>::read_some() {
  const auto room = buffer_.prepare(kReadBytes);
  const std::size_t count = co_await stream_.async_read_some(room, asio::use_awaitable);
  buffer_.commit(count);
}

template <class Stream>
asio::awaitable<void> Session<Stream>::write(const std::string& text) {
  expires_after(limits_.request_deadline);
  co_await asio::async_write(stream_, asio::buffer(text), asio::use_awaitable);
}

/// Reads the header of a request; returns its bytes, or the parse error. Throws when the connection ends.
template <class Stream>
asio::awaitable<std::variant<std::string, boost::system::error_code>> Session<Stream>::read_header(
    Parser& parser) {
  std::string raw;
  while (true) {
    boost::system::error_code failure;
    const std::size_t used = parser.put(buffer_.cdata(), failure);
    raw.append(static_cast<const char*>(buffer_.cdata().data()), used);
    buffer_.consume(used);
    if (failure && failure != http::error::need_more) co_return failure;
    if (parser.is_header_done()) co_return raw;
    co_await read_some();
  }
}

/// Reads one request; returns what is wrong with it. An error in the header is reported before the body
/// comes, which the client may hold back (Expect). Throws when the connection ends.
template <class Stream>
asio::awaitable<std::optional<Problem>> Session<Stream>::read_request(Parser& parser) {
  boost::system::error_code failure;
  const auto header = co_await read_header(parser);
  if (const auto* raw = std::get_if<std::string>(&header)) {
    if (auto problem = find_http_fault(parser.get(), *raw, ends_)) co_return problem;
    if (parser.is_done()) co_return std::nullopt;
    const std::uint64_t body_max = body_bytes_max(parser.get(), handler_, limits_);
    if (parser.content_length().value_or(0) > body_max) co_return too_large();
    parser.body_limit(body_max);
    co_await http::async_read(stream_, buffer_, parser, asio::redirect_error(asio::use_awaitable, failure));
    if (!failure) co_return std::nullopt;
  } else {
    failure = std::get<boost::system::error_code>(header);
  }
  auto problem = problem_of(failure);
  if (!problem) throw boost::system::system_error(failure);
  co_return problem;
}

/// A client that does not read its events within the deadline is disconnected.
template <class Stream>
asio::awaitable<void> Session<Stream>::write_events(const HttpRequest& request) {
  const std::unique_ptr<EventSource> events = handler_.events(request);
  while (true) {
    std::string text = events->due();
    if (text.empty()) text = ": nothing new\n\n";
    co_await write(text);
    if (events->ended()) co_return;
    beast::get_lowest_layer(stream_).expires_never();
    co_await events->wait();
  }
}

/// False when the connection is to end.
template <class Stream>
asio::awaitable<bool> Session<Stream>::serve_one() {
  Parser parser;
  parser.header_limit(limits_.header_bytes_max);
  parser.body_limit(std::max<std::uint64_t>(limits_.body_bytes_max, handler_.largest_body_bytes()));
  if (buffer_.size() == 0) {
    expires_after(limits_.idle_deadline);
    co_await read_some();
  }
  expires_after(limits_.request_deadline);
  auto problem = co_await read_request(parser);
  const bool head = parser.get().method() == http::verb::head;
  const unsigned minor = parser.get().version() % 10;
  std::optional<HttpRequest> request;
  if (!problem) {
    request = to_request(parser.get(), ends_, handler_);
    if (!request) problem = bad_target(view(parser.get().target()));
  }
  if (problem) {
    const HttpRequest refused{.method = method_of(parser.get()),
                              .path = std::string(parser.get().target()),
                              .remote = ends_.remote};
    const std::string text = response_text(handler_.refuse(*problem, refused), minor, false, head);
    co_await write(text);
    co_return false;
  }
  const bool keep_alive = parser.get().keep_alive();
  beast::get_lowest_layer(stream_).expires_never();
  const HttpResponse response = co_await handler_.answer(*request);
  const bool is_stream = response.content_type == kEventStreamType;
  const std::string text = response_text(response, minor, keep_alive && !is_stream, head);
  co_await write(text);
  if (!is_stream || head) co_return keep_alive && !is_stream;
  co_await write_events(*request);
  co_return false;
}

template <class Stream>
asio::awaitable<void> Session<Stream>::serve() {
  if constexpr (std::is_same_v<Stream, TlsStream>) {
    expires_after(limits_.request_deadline);
    co_await stream_.async_handshake(asio::ssl::stream_base::server, asio::use_awaitable);
  }
  bool goes_on = true;
  while (goes_on) goes_on = co_await serve_one();
  co_await finish();
}

/// Closes a connection so that the last answer arrives: closing with unread bytes would reset it.
template <class Stream>
asio::awaitable<void> Session<Stream>::finish() {
  boost::system::error_code failure;
  expires_after(limits_.request_deadline);
  if constexpr (std::is_same_v<Stream, TlsStream>) {
    co_await stream_.async_shutdown(asio::redirect_error(asio::use_awaitable, failure));
    co_return;
  }
  beast::get_lowest_layer(stream_).socket().shutdown(tcp::socket::shutdown_send, failure);
  std::array<char, kReadBytes> unread;
  const auto room = asio::buffer(unread);
  while (!failure) co_await stream_.async_read_some(room, asio::redirect_error(asio::use_awaitable, failure));
}

}  // namespace

asio::awaitable<void> serve_session(tcp::socket socket, RequestHandler& handler, HttpLimits limits) {
  socket.set_option(tcp::no_delay(true));
  Ends ends(socket, "http://", limits.host_names);
  Session<PlainStream> session(PlainStream(std::move(socket)), handler, limits, std::move(ends));
  co_await session.serve();
}

asio::awaitable<void> serve_tls_session(tcp::socket socket, asio::ssl::context& tls, RequestHandler& handler,
                                        HttpLimits limits) {
  socket.set_option(tcp::no_delay(true));
  Ends ends(socket, "https://", limits.host_names);
  Session<TlsStream> session(TlsStream(beast::tcp_stream(std::move(socket)), tls), handler, limits,
                             std::move(ends));
  co_await session.serve();
}

}  // namespace cell
