#pragma once

#include <spdlog/spdlog.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <new>
#include <utility>

namespace cell {

/// Hands each connection to `serve` until the acceptor is closed. Memory that runs out, here or in `serve`,
/// ends one connection and never the loop: nobody could stop the robot any more.
template <class Protocol>
boost::asio::awaitable<void> accept_connections(boost::asio::basic_socket_acceptor<Protocol>& acceptor,
                                                std::function<void(typename Protocol::socket)> serve) {
  namespace asio = boost::asio;
  while (acceptor.is_open()) {
    boost::system::error_code failure;
    typename Protocol::socket socket(acceptor.get_executor());
    try {
      co_await acceptor.async_accept(socket, asio::redirect_error(asio::use_awaitable, failure));
    } catch (const std::bad_alloc&) {
      failure = asio::error::no_memory;
    }
    if (failure == asio::error::operation_aborted) break;
    try {
      if (!failure) {
        serve(std::move(socket));
        continue;
      }
      // Out of descriptors or memory: present connections will end.
      spdlog::warn("a connection could not be accepted: {}", failure.message());
      asio::steady_timer pause(acceptor.get_executor(), std::chrono::milliseconds(100));
      co_await pause.async_wait(asio::redirect_error(asio::use_awaitable, failure));
    } catch (const std::exception& error) {
      spdlog::error("a connection could not be served: {}", error.what());
    }
  }
}

/// Logs why a session ended, unless its client went away.
inline void log_end(const std::exception_ptr& thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const boost::system::system_error&) {
    // the client went away
  } catch (const std::exception& error) {
    spdlog::error("a request failed: {}", error.what());
  }
}

}  // namespace cell
