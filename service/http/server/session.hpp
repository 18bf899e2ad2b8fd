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

/// Limits on clients, and accepted names of the daemon.
struct HttpLimits {
  int connections_max = 256;
  int address_connections_max = 32;    // of one address
  int loopback_connections_max = 224;  // of a loopback address, where a proxy may serve many clients
  std::uint32_t header_bytes_max = 8 * 1024;
  std::uint64_t body_bytes_max = kBodyBytesMax;  // unless the route allows more
  std::chrono::seconds request_deadline{5};      // to receive a request, and to send an answer
  std::chrono::seconds idle_deadline{60};
  /// Besides the address and the loopback names: those of the certificate or of a proxy.
  std::vector<std::string> host_names = {};
};

/// Serves one connection until it ends. Refuses what Beast accepts although RFC 9110 and 9112 forbid it (a
/// missing or foreign Host, unknown transfer encodings, absolute targets). Throws boost::system::system_error
/// when the client disconnects.
boost::asio::awaitable<void> serve_session(boost::asio::ip::tcp::socket socket, RequestHandler& handler,
                                           HttpLimits limits);
boost::asio::awaitable<void> serve_tls_session(boost::asio::ip::tcp::socket socket,
                                               boost::asio::ssl::context& tls, RequestHandler& handler,
                                               HttpLimits limits);

}  // namespace cell
