#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace cell {

/// A line to a port of this machine, on a thread of its own, that carries so many bytes each way in a tick.
class SlowLine {
 public:
  SlowLine(std::uint16_t to, std::size_t bytes, std::chrono::milliseconds tick)
      : bytes_(bytes), tick_(tick), to_(boost::asio::ip::address_v4::loopback(), to) {
    boost::asio::co_spawn(context_, listen(), boost::asio::detached);
    thread_ = std::thread([this] { context_.run(); });
  }
  ~SlowLine() {
    context_.stop();
    thread_.join();
  }
  SlowLine(const SlowLine&) = delete;
  SlowLine& operator=(const SlowLine&) = delete;

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  using Socket = boost::asio::ip::tcp::socket;

  boost::asio::awaitable<void> listen() {
    for (;;) {
      const auto here = std::make_shared<Socket>(co_await acceptor_.async_accept(boost::asio::use_awaitable));
      const auto there = std::make_shared<Socket>(context_);
      co_await there->async_connect(to_, boost::asio::use_awaitable);
      boost::asio::co_spawn(context_, carry(here, there), boost::asio::detached);
      boost::asio::co_spawn(context_, carry(there, here), boost::asio::detached);
    }
  }
  boost::asio::awaitable<void> carry(std::shared_ptr<Socket> from, std::shared_ptr<Socket> to) const {
    boost::asio::steady_timer tick(co_await boost::asio::this_coro::executor);
    std::vector<char> carried(bytes_);
    try {
      for (;;) {
        const std::size_t size =
            co_await from->async_read_some(boost::asio::buffer(carried), boost::asio::use_awaitable);
        tick.expires_after(tick_);
        co_await tick.async_wait(boost::asio::use_awaitable);
        co_await boost::asio::async_write(*to, boost::asio::buffer(carried, size),
                                          boost::asio::use_awaitable);
      }
    } catch (const boost::system::system_error&) {
      boost::system::error_code ignored;
      from->close(ignored);
      to->close(ignored);
    }
  }

  std::size_t bytes_;
  std::chrono::milliseconds tick_;
  boost::asio::ip::tcp::endpoint to_;
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
  std::thread thread_;
};

}  // namespace cell
