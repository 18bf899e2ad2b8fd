#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "service/http/server/connection_table.hpp"
#include "service/http/server/host_name.hpp"
#include "service/http/server/http_message.hpp"

namespace boost::asio::ssl {
class context;
}

namespace cell {

class BodyBudget;
class RequestHandler;

/// Limits on clients, and accepted names of the daemon.
struct HttpLimits {
  ConnectionQuota connections = {};
  std::uint32_t header_bytes_max = 8 * 1024;
  std::uint64_t body_bytes_max = kBodyBytesMax;           // unless the route allows more
  std::size_t bodies_bytes_max = 16UL * 1024UL * 1024UL;  // of all connections together
  /// To receive a request, the first one with its handshake; and to send an answer.
  std::chrono::seconds request_deadline{5};
  std::chrono::seconds idle_deadline{60};
  /// Besides the address and the loopback names: those of the certificate or of a proxy.
  std::vector<HostName> host_names = {};
  /// Reading over loopback needs no token. Behind a proxy every client comes over loopback.
  bool trusts_loopback = true;
};

/// Serves one connection until it ends. Refuses what Beast accepts although RFC 9110 and 9112 forbid it (a
/// missing or foreign Host, unknown transfer encodings, absolute targets), and chunk extensions. What stands
/// in the header decides before a body is read; trailers are not looked at. `handler` must outlive
/// it; `connection` is kept up to date. Throws boost::system::system_error when the client disconnects.
boost::asio::awaitable<void> serve_session(boost::asio::ip::tcp::socket socket, RequestHandler& handler,
                                           HttpLimits limits, std::shared_ptr<BodyBudget> bodies,
                                           std::shared_ptr<Connection> connection);
boost::asio::awaitable<void> serve_tls_session(boost::asio::ip::tcp::socket socket,
                                               boost::asio::ssl::context& tls, RequestHandler& handler,
                                               HttpLimits limits, std::shared_ptr<BodyBudget> bodies,
                                               std::shared_ptr<Connection> connection);
/// Over a Unix socket: its client is on this machine, whatever Host it names.
boost::asio::awaitable<void> serve_local_session(boost::asio::local::stream_protocol::socket socket,
                                                 RequestHandler& handler, HttpLimits limits,
                                                 std::shared_ptr<BodyBudget> bodies,
                                                 std::shared_ptr<Connection> connection);

}  // namespace cell
