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
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <memory>
#include <utility>
#include <variant>

#include "service/http/server/body_budget.hpp"
#include "service/http/server/ends.hpp"
#include "service/http/server/request_handler.hpp"
#include "service/http/server/request_head.hpp"
#include "service/http/server/response_text.hpp"

namespace cell {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

constexpr std::size_t kReadBytes = 4096;

using Parser = http::request_parser<http::string_body>;
using PlainStream = beast::tcp_stream;
using LocalStream = beast::basic_stream<asio::local::stream_protocol>;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

std::string string_of(beast::string_view text) { return {text.data(), text.size()}; }

RequestHead head_of(const Parser& parser, std::string bytes) {
  const auto& request = parser.get();
  RequestHead head{.method = string_of(request.method_string()),
                   .target = string_of(request.target()),
                   .version = request.version(),
                   .is_chunked = parser.chunked(),
                   .bytes = std::move(bytes)};
  for (const auto& field : request)
    head.fields.emplace_back(string_of(field.name_string()), string_of(field.value()));
  return head;
}

Problem too_large() {
  return {.status = 413, .kind = ProblemKind::kTooLarge, .detail = "the body is too large"};
}

Problem expectation_failed() {
  return {.status = 417, .kind = ProblemKind::kExpect, .detail = "Expect is not supported"};
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

/// Nobody needs an extension of a chunk, and one that does not end would be kept.
void refuse_chunk_extension(std::uint64_t, beast::string_view extension, boost::system::error_code& failure) {
  if (!extension.empty()) failure = http::error::bad_chunk_extension;
}

/// Largest body of a request that takes one.
std::uint64_t body_bytes_max(const HeaderDecision& decision, const HttpLimits& limits) {
  return decision.body_bytes_max > kBodyBytesMax ? decision.body_bytes_max
                                                 : std::min(decision.body_bytes_max, limits.body_bytes_max);
}

/// Serves the requests of a connection in order, with or without TLS.
template <class Stream>
class Session {
 public:
  Session(Stream stream, RequestHandler& handler, const HttpLimits& limits,
          std::shared_ptr<BodyBudget> bodies, Ends ends, std::shared_ptr<Connection> connection)
      : stream_(std::move(stream)),
        handler_(handler),
        limits_(limits),
        bodies_(std::move(bodies)),
        ends_(std::move(ends)),
        connection_(std::move(connection)),
        buffer_(2 * std::size_t{limits.header_bytes_max} + kReadBytes) {
    connection_->end = [this] { beast::get_lowest_layer(stream_).close(); };
    expires_after(limits_.request_deadline);  // until the first request is here
  }
  ~Session() { connection_->end = {}; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  asio::awaitable<void> serve();

 private:
  asio::awaitable<bool> serve_one();
  asio::awaitable<std::optional<Problem>> read_checked_header(Parser& parser, RequestHead& head);
  asio::awaitable<std::optional<Problem>> read_body(Parser& parser, std::uint64_t bytes_max,
                                                    BodyClaim& claim);
  asio::awaitable<bool> answer(const HttpRequest& request, const RequestHead& head, bool keep_alive);
  asio::awaitable<bool> refuse(const Problem& problem, const RequestHead& head);
  asio::awaitable<void> wait_for_request();
  asio::awaitable<void> skip(std::uint64_t bytes);
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
  std::shared_ptr<BodyBudget> bodies_;
  Ends ends_;
  std::shared_ptr<Connection> connection_;
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

/// Reads the header of a request into `head`; returns what is wrong with it. Throws when the connection ends.
template <class Stream>
asio::awaitable<std::optional<Problem>> Session<Stream>::read_checked_header(Parser& parser,
                                                                             RequestHead& head) {
  auto header = co_await read_header(parser);
  if (auto* raw = std::get_if<std::string>(&header)) {
    head = head_of(parser, std::move(*raw));
    co_return find_http_fault(head, ends_);
  }
  head = head_of(parser, {});
  const auto& failure = std::get<boost::system::error_code>(header);
  auto problem = problem_of(failure);
  if (!problem) throw boost::system::system_error(failure);
  co_return problem;
}

/// Reads the body of a request; returns what is wrong with it. What is not yet part of the body, a chunk's
/// line or trailers, is bounded like a header. Throws when the connection ends.
template <class Stream>
asio::awaitable<std::optional<Problem>> Session<Stream>::read_body(Parser& parser, std::uint64_t bytes_max,
                                                                   BodyClaim& claim) {
  if (parser.content_length().value_or(0) > bytes_max) co_return too_large();
  parser.body_limit(bytes_max);
  parser.eager(true);
  auto chunk_rule = refuse_chunk_extension;
  parser.on_chunk_header(chunk_rule);
  while (true) {
    boost::system::error_code failure;
    buffer_.consume(parser.put(buffer_.cdata(), failure));
    if (failure && failure != http::error::need_more) {
      auto problem = problem_of(failure);
      if (!problem) throw boost::system::system_error(failure);
      co_return problem;
    }
    if (!claim.grow_to(parser.get().body().size())) {
      co_return Problem{.status = 503,
                        .kind = ProblemKind::kBusy,
                        .detail = "too many bodies are being received; send it again later",
                        .retry_after_s = 2};
    }
    if (parser.is_done()) co_return std::nullopt;
    if (buffer_.size() > limits_.header_bytes_max)
      co_return Problem{.kind = ProblemKind::kHttp,
                        .detail = "the line of a chunk or the trailers are too long"};
    co_await read_some();
  }
}

/// Discards so many bytes of a body that nobody needs, so that the connection can go on.
template <class Stream>
asio::awaitable<void> Session<Stream>::skip(std::uint64_t bytes) {
  expires_after(limits_.request_deadline);
  while (true) {
    const std::uint64_t here = std::min<std::uint64_t>(bytes, buffer_.size());
    buffer_.consume(here);
    bytes -= here;
    if (bytes == 0) co_return;
    co_await read_some();
  }
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

/// Answers what is not served; the connection is to end.
template <class Stream>
asio::awaitable<bool> Session<Stream>::refuse(const Problem& problem, const RequestHead& head) {
  const HttpRequest refused{.method = head.route_method(), .path = head.target, .remote = ends_.remote()};
  const std::string text =
      response_text(handler_.refuse(problem, refused), head.version % 10, false, head.is_head());
  co_await write(text);
  co_return false;
}

/// False when the connection is to end.
template <class Stream>
asio::awaitable<bool> Session<Stream>::answer(const HttpRequest& request, const RequestHead& head,
                                              bool keep_alive) {
  beast::get_lowest_layer(stream_).expires_never();
  connection_->is_answering = true;
  const HttpResponse response = co_await handler_.answer(request);
  const bool is_stream = response.content_type == kEventStreamType;
  const std::string text =
      response_text(response, head.version % 10, keep_alive && !is_stream, head.is_head());
  co_await write(text);
  if (is_stream && !head.is_head()) co_await write_events(request);
  connection_->is_answering = false;
  connection_->use();
  co_return keep_alive && !is_stream;
}

/// The first bytes of the next request, which may come late; of the first one they may not.
template <class Stream>
asio::awaitable<void> Session<Stream>::wait_for_request() {
  if (!connection_->has_requested) co_return;
  if (buffer_.size() == 0) {
    expires_after(limits_.idle_deadline);
    co_await read_some();
  }
  expires_after(limits_.request_deadline);
}

/// False when the connection is to end. A request that is refused, or a stop, is answered before its body
/// comes, which may be large or never end.
template <class Stream>
asio::awaitable<bool> Session<Stream>::serve_one() {
  Parser parser;
  parser.header_limit(limits_.header_bytes_max);
  parser.body_limit(boost::none);  // whose it is decides first
  co_await wait_for_request();
  RequestHead head;
  auto problem = co_await read_checked_header(parser, head);
  if (problem) co_return co_await refuse(*problem, head);
  auto parsed = to_request(head, ends_, handler_);
  if (const auto* bad_target = std::get_if<Problem>(&parsed)) co_return co_await refuse(*bad_target, head);
  HttpRequest& request = std::get<HttpRequest>(parsed);
  bool keep_alive = parser.get().keep_alive();  // not what a trailer says
  const HeaderDecision decision = handler_.decide(request);
  connection_->has_requested = true;
  connection_->token = std::max(connection_->token, decision.token);
  connection_->use();
  const bool expects = head.count("Expect") > 0;
  if (expects && decision.takes_body) co_return co_await refuse(expectation_failed(), head);
  BodyClaim claim(bodies_);
  std::uint64_t unread = 0;
  if (request.announces_body && decision.takes_body) {
    problem = co_await read_body(parser, body_bytes_max(decision, limits_), claim);
    if (problem) co_return co_await refuse(*problem, head);
    request.body = std::move(parser.get().body());
  } else if (request.announces_body) {
    unread = parser.content_length().value_or(limits_.body_bytes_max + 1);
    // Who expects to be asked for the body may keep it back: what follows cannot be told apart then.
    keep_alive = keep_alive && !expects && unread <= limits_.body_bytes_max;
  }
  const bool goes_on = co_await answer(request, head, keep_alive);
  if (goes_on && unread > 0) co_await skip(unread);
  co_return goes_on;
}

template <class Stream>
asio::awaitable<void> Session<Stream>::serve() {
  if constexpr (std::is_same_v<Stream, TlsStream>) {
    co_await stream_.async_handshake(asio::ssl::stream_base::server, asio::use_awaitable);
  }
  bool goes_on = !connection_->is_closed;
  while (goes_on) goes_on = co_await serve_one();
  connection_->token = TokenRank::kNone;  // it only ends: its place may be given to another
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
  beast::get_lowest_layer(stream_).socket().shutdown(asio::socket_base::shutdown_send, failure);
  std::array<char, kReadBytes> unread;
  const auto room = asio::buffer(unread);
  while (!failure) co_await stream_.async_read_some(room, asio::redirect_error(asio::use_awaitable, failure));
}

}  // namespace

asio::awaitable<void> serve_session(tcp::socket socket, RequestHandler& handler, HttpLimits limits,
                                    std::shared_ptr<BodyBudget> bodies,
                                    std::shared_ptr<Connection> connection) {
  socket.set_option(tcp::no_delay(true));
  Ends ends(socket.remote_endpoint(), socket.local_endpoint(), "http://", limits);
  Session<PlainStream> session(PlainStream(std::move(socket)), handler, limits, std::move(bodies),
                               std::move(ends), std::move(connection));
  co_await session.serve();
}

asio::awaitable<void> serve_tls_session(tcp::socket socket, asio::ssl::context& tls, RequestHandler& handler,
                                        HttpLimits limits, std::shared_ptr<BodyBudget> bodies,
                                        std::shared_ptr<Connection> connection) {
  socket.set_option(tcp::no_delay(true));
  Ends ends(socket.remote_endpoint(), socket.local_endpoint(), "https://", limits);
  Session<TlsStream> session(TlsStream(beast::tcp_stream(std::move(socket)), tls), handler, limits,
                             std::move(bodies), std::move(ends), std::move(connection));
  co_await session.serve();
}

asio::awaitable<void> serve_local_session(asio::local::stream_protocol::socket socket,
                                          RequestHandler& handler, HttpLimits limits,
                                          std::shared_ptr<BodyBudget> bodies,
                                          std::shared_ptr<Connection> connection) {
  Session<LocalStream> session(LocalStream(std::move(socket)), handler, limits, std::move(bodies),
                               Ends::of_unix_socket(), std::move(connection));
  co_await session.serve();
}

}  // namespace cell
