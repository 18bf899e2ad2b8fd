#include "service/http/server/connection_table.hpp"

#include <algorithm>
#include <boost/asio/ip/address_v6.hpp>

namespace cell {

namespace ip = boost::asio::ip;

namespace {

/// What is closed first has the lowest rank; what has shown a token is not closed.
constexpr int kNotClosed = 3;
int closing_rank(const Connection& connection) {
  if (connection.has_token) return kNotClosed;
  if (!connection.has_requested) return 0;
  return connection.is_answering ? 2 : 1;
}

}  // namespace

ConnectionOrigin origin_of(const ip::address& client) {
  if (client.is_v4() || client.is_loopback()) return {client.is_loopback(), client.to_string()};
  const ip::address_v6 address = client.to_v6();
  if (address.is_v4_mapped()) return origin_of(ip::make_address_v4(ip::v4_mapped, address));
  ip::address_v6::bytes_type bytes = address.to_bytes();
  constexpr std::size_t kNetworkBytes = 8;
  std::fill(bytes.begin() + kNetworkBytes, bytes.end(), std::uint8_t{0});
  return {false, ip::address_v6(bytes).to_string() + "/64"};
}

/// Whether one more of the connections that count may come, after one that may be closed was, if need be.
bool ConnectionTable::make_room(int most, const Test& counts, const Test& may_close) {
  const auto counted = [&](const std::shared_ptr<Connection>& one) { return counts(*one); };
  if (std::ranges::count_if(connections_, counted) < most) return true;
  const auto victim = std::ranges::min_element(
      connections_, {}, [&](const auto& one) { return may_close(*one) ? closing_rank(*one) : kNotClosed; });
  if (victim == connections_.end() || !may_close(**victim) || closing_rank(**victim) == kNotClosed)
    return false;
  const std::shared_ptr<Connection> closed = *victim;
  connections_.erase(victim);
  closed->is_closed = true;
  if (closed->end) closed->end();
  return true;
}

std::shared_ptr<Connection> ConnectionTable::take(const ConnectionOrigin& origin) {
  const int of_network =
      origin.is_loopback ? quota_.loopback_connections_max : quota_.address_connections_max;
  const auto is_of_network = [&](const Connection& one) { return one.origin.network == origin.network; };
  const auto is_remote = [](const Connection& one) { return !one.origin.is_loopback; };
  const auto is_any = [](const Connection&) { return true; };
  // Other machines do not close what comes from this one.
  const auto is_closable = [&](const Connection& one) { return origin.is_loopback || is_remote(one); };
  if (!make_room(of_network, is_of_network, is_of_network)) return nullptr;
  if (!origin.is_loopback && !make_room(quota_.remote_connections_max, is_remote, is_remote)) return nullptr;
  if (!make_room(quota_.connections_max, is_any, is_closable)) return nullptr;
  connections_.push_back(std::make_shared<Connection>(Connection{.origin = origin}));
  return connections_.back();
}

void ConnectionTable::give_back(const std::shared_ptr<Connection>& connection) {
  connections_.remove(connection);
}

}  // namespace cell
