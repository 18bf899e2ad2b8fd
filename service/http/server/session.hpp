#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "service/http/server/http_message.hpp"

namespace boost::asio::ssl {
class context;
}

namespace cell {

class RequestHandler;

/// Bounds of what one client may cost, and of how it may name the daemon.
struct HttpLimits {
  int connections_max = 256;
  int address_connections_max = 32;    // of one address
  int loopback_connections_max = 224;  // of one address of this machine, where a proxy may stand for many
  std::uint32_t header_bytes_max = 8 * 1024;
  std::uint64_t body_bytes_max = kBodyBytesMax;  // where the route does not take more
  std::chrono::seconds request_deadline{5};      // from its first byte to its last, and for the answer
  std::chrono::seconds idle_deadline{60};
  /// Beside the socket's address and loopback's names: those of the certificate, or of a proxy before it.
  std::vector<std::string> host_names = {};
};

/// Serves one connection until it ends. What Beast lets through although RFC 9110 and 9112 forbid it is
/// refused here (a missing or foreign Host, odd transfer encodings, absolute targets). Throws
/// boost::system::system_error when the client goes away.
boost::asio::awaitable<void> serve_session(boost::asio::ip::tcp::socket socket, RequestHandler& handler,
                                           HttpLimits limits);
boost::asio::awaitable<void> serve_tls_session(boost::asio::ip::tcp::socket socket,
                                               boost::asio::ssl::context& tls, RequestHandler& handler,
                                               HttpLimits limits);

}  // namespace cell
