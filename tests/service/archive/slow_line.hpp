#pragma once

#include <array>
#include <atomic>
#include <boost/asio.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <utility>

namespace cell {

/// A port of this machine that carries to a server's Unix socket, as a line to another site does: each answer
/// comes `delay` late, and a connection breaks off after so many round trips (0: never).
class SlowLine {
 public:
  SlowLine(std::string server, std::chrono::milliseconds delay, int round_trips_max = 0)
      : server_(std::move(server)), delay_(delay), round_trips_max_(round_trips_max) {
    boost::asio::co_spawn(io_, accept(), boost::asio::detached);
    thread_ = std::jthread([this] { io_.run(); });
  }
  SlowLine(const SlowLine&) = delete;
  SlowLine& operator=(const SlowLine&) = delete;
  ~SlowLine() { io_.stop(); }

  [[nodiscard]] int port() const { return acceptor_.local_endpoint().port(); }
  [[nodiscard]] int round_trips() const { return round_trips_; }

 private:
  using Tcp = boost::asio::ip::tcp;
  using Unix = boost::asio::local::stream_protocol;
  template <class T = void>
  using Awaitable = boost::asio::awaitable<T>;

  struct Connection {
    Connection(Tcp::socket from, Unix::socket to) : client(std::move(from)), server(std::move(to)) {}

    Tcp::socket client;
    Unix::socket server;
    bool asked = false;
    int round_trips = 0;

    void close() {
      boost::system::error_code ignored;
      client.close(ignored);
      server.close(ignored);
    }
  };

  Awaitable<> accept() {
    while (true) {
      Tcp::socket client = co_await acceptor_.async_accept(boost::asio::use_awaitable);
      Unix::socket server(io_);
      co_await server.async_connect(Unix::endpoint(server_), boost::asio::use_awaitable);
      const auto connection = std::make_shared<Connection>(std::move(client), std::move(server));
      const auto closed = [connection](const std::exception_ptr&) { connection->close(); };
      boost::asio::co_spawn(io_, ask(connection), closed);
      boost::asio::co_spawn(io_, answer(connection), closed);
    }
  }

  Awaitable<> ask(std::shared_ptr<Connection> connection) {
    std::array<char, 65536> bytes{};
    while (true) {
      const std::size_t count =
          co_await connection->client.async_read_some(boost::asio::buffer(bytes), boost::asio::use_awaitable);
      connection->asked = true;
      co_await boost::asio::async_write(connection->server, boost::asio::buffer(bytes.data(), count),
                                        boost::asio::use_awaitable);
    }
  }

  Awaitable<> answer(std::shared_ptr<Connection> connection) {
    std::array<char, 65536> bytes{};
    boost::asio::steady_timer late(io_);
    while (true) {
      const std::size_t count =
          co_await connection->server.async_read_some(boost::asio::buffer(bytes), boost::asio::use_awaitable);
      if (std::exchange(connection->asked, false)) {
        ++round_trips_;
        ++connection->round_trips;
      }
      if (connection->round_trips == round_trips_max_ && round_trips_max_ > 0) co_return;
      late.expires_after(delay_);
      co_await late.async_wait(boost::asio::use_awaitable);
      co_await boost::asio::async_write(connection->client, boost::asio::buffer(bytes.data(), count),
                                        boost::asio::use_awaitable);
    }
  }

  std::string server_;
  std::chrono::milliseconds delay_;
  int round_trips_max_;
  std::atomic<int> round_trips_ = 0;
  boost::asio::io_context io_;
  Tcp::acceptor acceptor_{io_, Tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
  std::jthread thread_;  // the last member: it uses the others
};

}  // namespace cell
