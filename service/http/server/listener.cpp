#include "service/http/server/listener.hpp"

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <utility>

#include "service/http/server/internal/accepting.hpp"
#include "service/http/server/request_handler.hpp"
#include "service/http/server/response_text.hpp"

namespace cell {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

/// Connections that are told at once that there is no place for them; more are only closed.
constexpr int kTurnedAwayMax = 32;

/// Says `text`, and closes when the client has read it or after a second: unread bytes would reset it.
asio::awaitable<void> turn_away(tcp::socket socket, std::string text) {
  boost::beast::tcp_stream stream(std::move(socket));
  stream.expires_after(std::chrono::seconds(1));
  co_await asio::async_write(stream, asio::buffer(text), asio::use_awaitable);
  boost::system::error_code failure;
  stream.socket().shutdown(tcp::socket::shutdown_send, failure);
  std::array<char, 4096> unread;
  const auto room = asio::buffer(unread);
  while (!failure) co_await stream.async_read_some(room, asio::redirect_error(asio::use_awaitable, failure));
}

}  // namespace

HttpListener::HttpListener(asio::any_io_executor executor, const tcp::endpoint& address,
                           RequestHandler& handler, HttpLimits limits,
                           std::shared_ptr<asio::ssl::context> tls)
    : executor_(executor),
      acceptor_(executor, address),
      address_(acceptor_.local_endpoint()),
      limits_(limits),
      tls_(std::move(tls)),
      handler_(handler),
      bodies_(std::make_shared<BodyBudget>(limits.bodies_bytes_max)),
      connections_(limits.connections) {}

void HttpListener::launch() {
  asio::co_spawn(executor_,
                 accept_connections<tcp>(acceptor_, [this](tcp::socket socket) { serve(std::move(socket)); }),
                 asio::detached);
}

void HttpListener::close() { acceptor_.close(); }

void HttpListener::serve(tcp::socket socket) {
  boost::system::error_code gone;
  const asio::ip::address client = socket.remote_endpoint(gone).address();
  if (gone) return;  // the socket closes here
  const std::shared_ptr<Connection> connection = connections_.take(origin_of(client));
  if (!connection) {
    tell_full(std::move(socket), client);
    return;
  }
  const auto ended = [this, connection](const std::exception_ptr& thrown) {
    connections_.give_back(connection);
    log_end(thrown);
  };
  asio::co_spawn(executor_,
                 tls_ ? serve_tls_session(std::move(socket), *tls_, handler_, limits_, bodies_, connection)
                      : serve_session(std::move(socket), handler_, limits_, bodies_, connection),
                 ended);
}

void HttpListener::tell_full(tcp::socket socket, const asio::ip::address& client) {
  if (tls_ || turned_away_ >= kTurnedAwayMax) return;
  const Problem full{.status = 503,
                     .kind = ProblemKind::kBusy,
                     .detail =
                         "all connections are in use by clients with a token; close some, or use the "
                         "Unix socket in the state directory",
                     .retry_after_s = 5};
  const HttpRequest unread{.method = "GET", .remote = client.to_string()};
  std::string text = response_text(handler_.refuse(full, unread), 1, false, false);
  ++turned_away_;
  asio::co_spawn(executor_, turn_away(std::move(socket), std::move(text)),
                 [this](const std::exception_ptr&) { --turned_away_; });
}

}  // namespace cell
