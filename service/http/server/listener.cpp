#include "service/http/server/listener.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "service/http/server/request_handler.hpp"

namespace cell {

namespace asio = boost::asio;
using asio::ip::tcp;

HttpListener::HttpListener(asio::any_io_executor executor, const tcp::endpoint& address,
                           RequestHandler& handler, HttpLimits limits,
                           std::shared_ptr<asio::ssl::context> tls)
    : executor_(executor),
      acceptor_(executor, address),
      address_(acceptor_.local_endpoint()),
      limits_(limits),
      tls_(std::move(tls)),
      handler_(handler) {}

void HttpListener::launch() { asio::co_spawn(executor_, accept(), asio::detached); }

void HttpListener::close() { acceptor_.close(); }

bool HttpListener::has_room(const asio::ip::address& client) const {
  if (connections_ >= limits_.connections_max) return false;
  const auto found = connections_of_.find(client);
  const int most = client.is_loopback() ? limits_.loopback_connections_max : limits_.address_connections_max;
  return found == connections_of_.end() || found->second < most;
}

asio::awaitable<void> HttpListener::accept() {
  while (acceptor_.is_open()) {
    boost::system::error_code failure;
    tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(asio::use_awaitable, failure));
    if (failure == asio::error::operation_aborted) break;
    if (failure) {
      // Out of descriptors: present connections will end.
      spdlog::warn("a connection could not be accepted: {}", failure.message());
      asio::steady_timer pause(executor_, std::chrono::milliseconds(100));
      co_await pause.async_wait(asio::redirect_error(asio::use_awaitable, failure));
      continue;
    }
    serve(std::move(socket));
  }
}

void HttpListener::serve(tcp::socket socket) {
  boost::system::error_code gone;
  const asio::ip::address client = socket.remote_endpoint(gone).address();
  if (gone || !has_room(client)) return;  // the socket closes here
  ++connections_;
  ++connections_of_[client];
  const auto ended = [this, client](const std::exception_ptr& thrown) {
    --connections_;
    if (--connections_of_[client] == 0) connections_of_.erase(client);
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const boost::system::system_error&) {
      // the client went away
    } catch (const std::exception& error) {
      spdlog::error("a request failed: {}", error.what());
    }
  };
  asio::co_spawn(executor_,
                 tls_ ? serve_tls_session(std::move(socket), *tls_, handler_, limits_)
                      : serve_session(std::move(socket), handler_, limits_),
                 ended);
}

}  // namespace cell
