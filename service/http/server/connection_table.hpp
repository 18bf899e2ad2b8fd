#pragma once

#include <boost/asio/ip/address.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>

namespace cell {

/// How many connections there may be at once.
struct ConnectionQuota {
  int connections_max = 256;
  int remote_connections_max = 192;    // of all other machines: the rest is for this one
  int address_connections_max = 32;    // of one address, or of one IPv6 network (/64)
  int loopback_connections_max = 224;  // of a loopback address, where a proxy may serve many clients
};

/// Where a connection comes from, as far as it is counted.
struct ConnectionOrigin {
  bool is_loopback = false;
  std::string network;  // the address; of IPv6 the first 64 bits, of which one machine may have all addresses
};
ConnectionOrigin origin_of(const boost::asio::ip::address& client);

/// One connection as the table sees it; its session keeps it up to date.
struct Connection {
  ConnectionOrigin origin;
  bool has_requested = false;      // a complete header has come
  bool has_token = false;          // with a token of the daemon
  bool is_answering = false;       // a request is being answered
  bool is_closed = false;          // its place was given to another one
  std::function<void()> end = {};  // closes it; empty before it is served and after
};

/// The connections of a listener. When there are too many, the oldest one that has not shown a token is
/// closed for a new one: first of those that have not sent a request, then of those that wait for nothing. Of
/// one thread.
class ConnectionTable {
 public:
  explicit ConnectionTable(const ConnectionQuota& quota) : quota_(quota) {}

  /// A place for a new connection; null if all of them are taken by connections with a token.
  std::shared_ptr<Connection> take(const ConnectionOrigin& origin);
  /// The connection has ended. Nothing happens if its place was already given to another.
  void give_back(const std::shared_ptr<Connection>& connection);

  [[nodiscard]] std::size_t count() const { return connections_.size(); }

 private:
  using Test = std::function<bool(const Connection&)>;
  [[nodiscard]] bool make_room(int most, const Test& counts, const Test& may_close);

  ConnectionQuota quota_;
  std::list<std::shared_ptr<Connection>> connections_;  // oldest first
};

}  // namespace cell
