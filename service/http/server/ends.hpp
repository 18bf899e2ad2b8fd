#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace cell {

struct HttpLimits;

/// The two ends of a connection and the accepted values of Host: another Host is a page that reached the
/// daemon under a name of its own (DNS rebinding).
class Ends {
 public:
  /// `scheme`: of an accepted Origin, "http://". A name that was given is also accepted as https: of a proxy
  /// that ends TLS before this daemon.
  Ends(const boost::asio::ip::tcp::endpoint& client, const boost::asio::ip::tcp::endpoint& own,
       std::string scheme, const HttpLimits& limits);
  /// Of a Unix socket, which no web page reaches: any Host, no Origin.
  static Ends of_unix_socket();

  /// Whether the client has the rights of this machine.
  [[nodiscard]] bool from_loopback() const { return from_loopback_; }
  [[nodiscard]] const std::string& remote() const { return remote_; }
  [[nodiscard]] bool is_our_host(std::string_view host) const;
  [[nodiscard]] bool is_our_origin(std::string_view origin) const;

 private:
  Ends() = default;

  bool from_loopback_ = true;
  std::string remote_ = "unix";
  std::string scheme_;
  std::vector<std::string> hosts_;        // empty for a Unix socket
  std::vector<std::string> given_names_;  // as clients write them, with a port or without
};

}  // namespace cell
