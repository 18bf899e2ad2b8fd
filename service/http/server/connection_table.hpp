#pragma once

#include <boost/asio/ip/address.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "service/http/server/token_rank.hpp"

namespace cell {

/// How many connections there may be at once, each at least one.
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

/// The requests of all connections of a table in their order, without a clock.
class UseCount {
 public:
  std::uint64_t next() { return ++*count_; }

 private:
  std::shared_ptr<std::uint64_t> count_ = std::make_shared<std::uint64_t>(0);
};

/// One connection as the table sees it; its session keeps it up to date.
struct Connection {
  ConnectionOrigin origin;
  UseCount uses;                       // of the table
  bool has_requested = false;          // a complete header has come
  TokenRank token = TokenRank::kNone;  // the highest that it has shown
  bool is_answering = false;           // a request is being answered, a long poll and a stream too
  std::uint64_t last_use = 0;          // when a request came or was answered, by `uses`
  bool is_closed = false;              // its place was given to another one
  std::function<void()> end = {};      // closes it; empty before it is served and after

  void use() { last_use = uses.next(); }
};

/// The connections of a listener. When there are too many, one is closed for a new one, so that a stop always
/// gets through: the first request of the new one decides how long that stays. Until it has come a connection
/// is spared as long as there are not more of its kind than an eighth of the places and another one without
/// an operate token can go. First goes the oldest
/// that has not shown a token (of those that have not sent a request, then that wait for nothing, then any),
/// then the one that has been idle longest of those with the view token, then of those with an operate token.
/// A request that is being answered, long polls and streams of events among them, keeps a connection with a
/// token until no idle one is left. Of one thread.
class ConnectionTable {
 public:
  explicit ConnectionTable(const ConnectionQuota& quota) : quota_(quota) {}

  /// A place for a new connection; there always is one.
  std::shared_ptr<Connection> take(const ConnectionOrigin& origin);
  /// The connection has ended. Nothing happens if its place was already given to another.
  void give_back(const std::shared_ptr<Connection>& connection);

  [[nodiscard]] std::size_t count() const { return connections_.size(); }

 private:
  using Test = std::function<bool(const Connection&)>;
  void make_room(int most, const Test& counts, const Test& may_close);
  [[nodiscard]] int count_of(const Test& counts) const;

  ConnectionQuota quota_;
  UseCount uses_;
  std::list<std::shared_ptr<Connection>> connections_;  // oldest first
};

}  // namespace cell
