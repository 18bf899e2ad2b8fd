#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <string>

#include "service/http/tokens.hpp"

namespace cell {

class Operation;

/// Bounds of what one client may cost.
struct HttpLimits {
  int connections_max = 256;
  std::uint32_t header_bytes_max = 8 * 1024;
  std::uint64_t body_bytes_max = 64 * 1024;
  std::chrono::seconds request_deadline{5};  // from its first byte to its last, and for the answer
  std::chrono::seconds idle_deadline{60};
};

/// Accepts, reads, routes, writes: HTTP/1.1 on one address. What Beast lets through although RFC 9110 and
/// 9112 forbid it is refused here (a missing or foreign Host, odd transfer encodings, absolute targets).
class HttpListener {
 public:
  /// Binds at once; port 0 takes a free one. Throws boost::system::system_error when the address is taken.
  HttpListener(boost::asio::any_io_executor executor, const boost::asio::ip::tcp::endpoint& address,
               Operation& operation, Tokens tokens, HttpLimits limits = {});

  void launch();
  void close();
  [[nodiscard]] boost::asio::ip::tcp::endpoint address() const { return address_; }

 private:
  boost::asio::awaitable<void> accept();
  boost::asio::awaitable<void> serve(boost::asio::ip::tcp::socket socket);

  boost::asio::any_io_executor executor_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::ip::tcp::endpoint address_;
  Operation& operation_;
  Tokens tokens_;
  HttpLimits limits_;
  int connections_ = 0;
};

}  // namespace cell
