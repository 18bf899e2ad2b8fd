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

#include "service/acquisition/operation.hpp"
#include "service/http/routes.hpp"

namespace cell {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

using Parser = http::request_parser<http::string_body>;
using Incoming = http::request<http::string_body>;

std::optional<std::string> field(const Incoming& request, beast::string_view name) {
  const auto found = request.find(name);
  return found == request.end() ? std::nullopt : std::optional<std::string>(found->value());
}

/// The names this daemon goes by: another Host is a page that reached us under a name of its own (DNS
/// rebinding).
bool is_our_host(std::string_view host, const tcp::endpoint& address) {
  const std::string port = std::to_string(address.port());
  const std::string own =
      address.address().is_v6() ? "[" + address.address().to_string() + "]" : address.address().to_string();
  const std::array<std::string, 4> names{"127.0.0.1", "localhost", "[::1]", own};
  return std::ranges::any_of(names, [&](const std::string& name) { return host == name + ":" + port; });
}

/// What Beast let through and the RFCs do not.
std::optional<Problem> find_http_fault(const Incoming& request, const tcp::endpoint& address) {
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
  if (request.count(http::field::content_length) > 1) {
    return Problem{.kind = "content-length", .detail = "one Content-Length is enough"};
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
                     .if_none_match = field(incoming, "If-None-Match"),
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
    boost::system::error_code failure;
    if (buffer.size() == 0) {
      stream.expires_after(limits_.idle_deadline);
      buffer.commit(co_await stream.async_read_some(buffer.prepare(4096), asio::use_awaitable));
    }
    stream.expires_after(limits_.request_deadline);
    co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, failure));

    std::optional<HttpResponse> response;
    if (failure) {
      const auto problem = problem_of(failure);
      if (!problem) co_return;
      response = to_response(*problem);
      keep_alive = false;
    } else if (const auto problem = find_http_fault(parser.get(), address_)) {
      response = to_response(*problem);
      keep_alive = false;
    } else if (const auto request = to_request(parser.get(), from_loopback)) {
      if (const auto wait = long_poll(*request)) {
        stream.expires_never();
        co_await operation_.wait_for_change(wait->after, wait->wait);
      }
      response = answer(*request, operation_, tokens_);
      keep_alive = parser.get().keep_alive();
    } else {
      response = to_response({.kind = "target", .detail = "the target must be a path"});
      keep_alive = false;
    }
    const bool head = !failure && parser.get().method() == http::verb::head;
    const unsigned version = failure ? 11 : parser.get().version();
    const auto message = to_message(std::move(*response), version, keep_alive, head);
    stream.expires_after(limits_.request_deadline);
    co_await http::async_write(stream, message, asio::use_awaitable);
  }
  boost::system::error_code ignored;
  stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

}  // namespace cell
