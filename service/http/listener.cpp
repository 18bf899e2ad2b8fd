#include "service/http/listener.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <utility>
#include <variant>

#include "service/acquisition/operation.hpp"
#include "service/http/routes.hpp"

namespace cell {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

constexpr std::size_t kReadBytes = 4096;

using Parser = http::request_parser<http::string_body>;
using Incoming = http::request<http::string_body>;

std::optional<std::string> field(const Incoming& request, beast::string_view name) {
  const auto found = request.find(name);
  return found == request.end() ? std::nullopt : std::optional<std::string>(found->value());
}

/// A field that holds a list may stand on several lines (RFC 9110, 5.3).
std::optional<std::string> list_field(const Incoming& request, beast::string_view name) {
  std::optional<std::string> joined;
  const auto [first, last] = request.equal_range(name);
  for (auto line = first; line != last; ++line)
    joined = joined ? *joined + ", " + std::string(line->value()) : std::string(line->value());
  return joined;
}

/// The names this daemon goes by: another Host is a page that reached us under a name of its own (DNS
/// rebinding).
bool is_our_host(std::string_view host, const tcp::endpoint& address) {
  const std::string port = std::to_string(address.port());
  const std::string own =
      address.address().is_v6() ? "[" + address.address().to_string() + "]" : address.address().to_string();
  const std::array<std::string, 4> names{"127.0.0.1", "localhost", "[::1]", own};
  return std::ranges::any_of(
      names, [&](const std::string& name) { return beast::iequals(host, name + ":" + port); });
}

/// What Beast let through and the RFCs do not. `raw_header`: the header's bytes, where folded lines still
/// show.
std::optional<Problem> find_http_fault(const Incoming& request, std::string_view raw_header,
                                       const tcp::endpoint& address) {
  if (raw_header.find("\r\n ") != raw_header.npos || raw_header.find("\r\n\t") != raw_header.npos) {
    return Problem{.kind = "http", .detail = "a header field stands on one line"};
  }
  const auto hosts = request.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && request.version() >= 11)) {
    return Problem{.kind = "host", .detail = "exactly one Host is wanted"};
  }
  if (hosts == 1 && !is_our_host(request[http::field::host], address)) {
    return Problem{.status = 421, .kind = "host", .detail = "this daemon does not go by that Host"};
  }
  if (request.count(http::field::transfer_encoding) > 0 &&
      (request.version() < 11 || request.count(http::field::transfer_encoding) > 1 ||
       !beast::iequals(request[http::field::transfer_encoding], "chunked"))) {
    return Problem{
        .status = 501, .kind = "transfer-encoding", .detail = "the only transfer encoding is chunked"};
  }
  if (request.count(http::field::content_length) > 1 ||
      request[http::field::content_length].find_first_not_of("0123456789") != beast::string_view::npos) {
    return Problem{.kind = "content-length", .detail = "Content-Length is one number"};
  }
  if (request.count(http::field::expect) > 0) {
    return Problem{.status = 417, .kind = "expect", .detail = "Expect is not supported"};
  }
  if (request.count(http::field::origin) > 0) {
    const std::string origin(request[http::field::origin]);
    if (!origin.starts_with("http://") || !is_our_host(std::string_view(origin).substr(7), address)) {
      return Problem{.status = 403, .kind = "origin", .detail = "requests from other pages are not taken"};
    }
  }
  return std::nullopt;
}

std::optional<HttpRequest> to_request(const Incoming& incoming, bool from_loopback) {
  auto target = parse_target(std::string_view(incoming.target().data(), incoming.target().size()));
  if (!target) return std::nullopt;
  const bool head = incoming.method() == http::verb::head;
  return HttpRequest{.method = head ? "GET" : std::string(incoming.method_string()),
                     .path = std::move(target->first),
                     .query = std::move(target->second),
                     .authorization = field(incoming, "Authorization"),
                     .content_type = field(incoming, "Content-Type"),
                     .idempotency_key = field(incoming, "Idempotency-Key"),
                     .if_none_match = list_field(incoming, "If-None-Match"),
                     .body = incoming.body(),
                     .from_loopback = from_loopback};
}

http::response<http::string_body> to_message(HttpResponse&& response, unsigned version, bool keep_alive,
                                             bool head) {
  http::response<http::string_body> message(static_cast<http::status>(response.status), version);
  message.set(http::field::server, "touchcald");
  message.set(http::field::cache_control, "no-store");
  message.set("X-Content-Type-Options", "nosniff");
  message.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
  message.set("Referrer-Policy", "no-referrer");
  for (const auto& [name, value] : response.headers) message.set(name, value);
  message.keep_alive(keep_alive);
  if (response.status == 304) return message;
  message.set(http::field::content_type, response.content_type);
  message.body() = std::move(response.body);
  message.prepare_payload();
  if (head) message.body().clear();
  return message;
}

/// The answer to bytes that are no request.
std::optional<Problem> problem_of(const boost::system::error_code& failure) {
  if (failure == http::error::body_limit) {
    return Problem{.status = 413, .kind = "too-large", .detail = "the body is too large"};
  }
  if (failure == http::error::header_limit || failure == http::error::buffer_overflow) {
    return Problem{.status = 431, .kind = "too-large", .detail = "the header is too large"};
  }
  if (failure == http::error::end_of_stream || failure == http::error::partial_message) return std::nullopt;
  if (failure.category() == http::make_error_code(http::error::bad_method).category()) {
    return Problem{.kind = "http", .detail = "this is no HTTP request: " + failure.message()};
  }
  return std::nullopt;  // a socket's own failure: nobody is there to read an answer
}

/// Reads a request's header; gives its bytes as they came, or why they are none. Throws when the connection
/// ends.
asio::awaitable<std::variant<std::string, boost::system::error_code>> read_header(beast::tcp_stream& stream,
                                                                                  beast::flat_buffer& buffer,
                                                                                  Parser& parser) {
  std::string raw;
  while (true) {
    boost::system::error_code failure;
    const std::size_t used = parser.put(buffer.cdata(), failure);
    raw.append(static_cast<const char*>(buffer.cdata().data()), used);
    buffer.consume(used);
    if (failure && failure != http::error::need_more) co_return failure;
    if (parser.is_header_done()) co_return raw;
    const auto room = buffer.prepare(kReadBytes);
    const std::size_t count = co_await stream.async_read_some(room, asio::use_awaitable);
    buffer.commit(count);
  }
}

/// Reads one request; gives what is wrong with it. What its header already shows is told without waiting for
/// its body, which may wait for a word of ours (Expect). Throws when the connection ends.
asio::awaitable<std::optional<Problem>> read_request(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                                     Parser& parser, const tcp::endpoint& address) {
  boost::system::error_code failure;
  const auto header = co_await read_header(stream, buffer, parser);
  if (const auto* raw = std::get_if<std::string>(&header)) {
    if (auto problem = find_http_fault(parser.get(), *raw, address)) co_return problem;
    if (parser.is_done()) co_return std::nullopt;
    co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, failure));
    if (!failure) co_return std::nullopt;
  } else {
    failure = std::get<boost::system::error_code>(header);
  }
  auto problem = problem_of(failure);
  if (!problem) throw boost::system::system_error(failure);
  co_return problem;
}

/// Ends a connection so that the last answer arrives: closing it over unread bytes would reset it.
asio::awaitable<void> finish(beast::tcp_stream& stream, std::chrono::seconds deadline) {
  boost::system::error_code failure;
  stream.socket().shutdown(tcp::socket::shutdown_send, failure);
  stream.expires_after(deadline);
  std::array<char, kReadBytes> unread;
  const auto room = asio::buffer(unread);
  while (!failure) co_await stream.async_read_some(room, asio::redirect_error(asio::use_awaitable, failure));
}

/// The route's answer; a failure inside is told without its inner workings and logged with them.
HttpResponse answer(const HttpRequest& request, Operation& operation, const Tokens& tokens) {
  try {
    return route(request, operation, tokens);
  } catch (const std::exception& error) {
    spdlog::error("{} {} failed: {}", request.method, request.path, error.what());
    return to_response(
        {.status = 500, .kind = "internal", .detail = "the daemon could not do this; see its log"});
  }
}

}  // namespace

HttpListener::HttpListener(asio::any_io_executor executor, const tcp::endpoint& address, Operation& operation,
                           Tokens tokens, HttpLimits limits)
    : executor_(executor),
      acceptor_(executor, address),
      address_(acceptor_.local_endpoint()),
      operation_(operation),
      tokens_(std::move(tokens)),
      limits_(limits) {}

void HttpListener::launch() { asio::co_spawn(executor_, accept(), asio::detached); }

void HttpListener::close() { acceptor_.close(); }

asio::awaitable<void> HttpListener::accept() {
  while (acceptor_.is_open()) {
    boost::system::error_code failure;
    tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(asio::use_awaitable, failure));
    if (failure == asio::error::operation_aborted) break;
    if (failure) {
      // Out of descriptors: those who are served end in time.
      spdlog::warn("a connection could not be accepted: {}", failure.message());
      asio::steady_timer pause(executor_, std::chrono::milliseconds(100));
      co_await pause.async_wait(asio::redirect_error(asio::use_awaitable, failure));
      continue;
    }
    if (connections_ >= limits_.connections_max) continue;  // the socket closes here
    ++connections_;
    asio::co_spawn(executor_, serve(std::move(socket)), [this](const std::exception_ptr& thrown) {
      --connections_;
      try {
        if (thrown) std::rethrow_exception(thrown);
      } catch (const boost::system::system_error&) {
        // the client went away
      } catch (const std::exception& error) {
        spdlog::error("a request failed: {}", error.what());
      }
    });
  }
}

asio::awaitable<void> HttpListener::serve(tcp::socket socket) {
  socket.set_option(tcp::no_delay(true));
  const bool from_loopback = socket.remote_endpoint().address().is_loopback();
  beast::tcp_stream stream(std::move(socket));
  beast::flat_buffer buffer(limits_.header_bytes_max + limits_.body_bytes_max);
  for (bool keep_alive = true; keep_alive;) {
    Parser parser;
    parser.header_limit(limits_.header_bytes_max);
    parser.body_limit(limits_.body_bytes_max);
    if (buffer.size() == 0) {
      stream.expires_after(limits_.idle_deadline);
      const auto room = buffer.prepare(kReadBytes);
      const std::size_t count = co_await stream.async_read_some(room, asio::use_awaitable);
      buffer.commit(count);
    }
    stream.expires_after(limits_.request_deadline);
    auto problem = co_await read_request(stream, buffer, parser, address_);
    const Incoming& incoming = parser.get();
    std::optional<HttpRequest> request;
    if (!problem) {
      request = to_request(incoming, from_loopback);
      if (!request) problem = Problem{.kind = "target", .detail = "the target must be a path"};
    }
    HttpResponse response;
    if (problem) {
      response = to_response(*problem);
      keep_alive = false;
    } else {
      if (const auto wait = from_loopback ? long_poll(*request) : std::nullopt) {
        stream.expires_never();
        co_await operation_.wait_for_change(wait->after, wait->wait);
      }
      if (const auto recipe = recipe_to_plan(*request, operation_, tokens_)) {
        stream.expires_never();
        co_await operation_.plan_recipe(*recipe);
      }
      response = answer(*request, operation_, tokens_);
      keep_alive = incoming.keep_alive();
    }
    const bool head = incoming.method() == http::verb::head;
    const auto message = to_message(std::move(response), incoming.version(), keep_alive, head);
    stream.expires_after(limits_.request_deadline);
    co_await http::async_write(stream, message, asio::use_awaitable);
  }
  co_await finish(stream, limits_.request_deadline);
}

}  // namespace cell
