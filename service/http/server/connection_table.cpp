#include "service/http/server/connection_table.hpp"

#include <algorithm>
#include <boost/asio/ip/address_v6.hpp>
#include <stdexcept>
#include <utility>

namespace cell {

namespace ip = boost::asio::ip;

namespace {

/// What is closed first is lowest: what it is worth, then how long ago it was used. All that has not shown a
/// token is as old as its place in the table.
std::pair<int, std::uint64_t> closing_order(const Connection& connection) {
  const bool is_answering = connection.is_answering;
  switch (connection.token) {
    case TokenRank::kNone:
      return {!connection.has_requested ? 0 : is_answering ? 2 : 1, 0};
    case TokenRank::kView:
      return {is_answering ? 5 : 3, connection.last_use};
    case TokenRank::kOperate:
      return {is_answering ? 6 : 4, connection.last_use};
  }
  return {};
}

/// One in so many places is for connections whose first request has not come yet.
constexpr int kShareOfNew = 8;

/// It may be a stop whose bytes are on their way.
bool is_new(const Connection& connection) {
  return !connection.has_requested && connection.token == TokenRank::kNone;
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

int ConnectionTable::count_of(const Test& counts) const {
  return static_cast<int>(std::ranges::count_if(connections_, [&](const auto& one) { return counts(*one); }));
}

/// Closes one that may be closed where as many as may be count already.
void ConnectionTable::make_room(int most, const Test& counts, const Test& may_close) {
  if (count_of(counts) < most) return;
  const auto is_new_here = [&](const Connection& one) { return is_new(one) && counts(one); };
  const auto may_close_known = [&](const Connection& one) {
    return !is_new(one) && one.token != TokenRank::kOperate && may_close(one);
  };
  const bool spares_new = count_of(is_new_here) <= most / kShareOfNew && count_of(may_close_known) > 0;
  auto victim = connections_.end();
  for (auto one = connections_.begin(); one != connections_.end(); ++one) {
    if (!may_close(**one) || (spares_new && is_new(**one))) continue;
    if (victim == connections_.end() || closing_order(**one) < closing_order(**victim)) victim = one;
  }
  if (victim == connections_.end()) throw std::logic_error("a quota of connections leaves no place");
  const std::shared_ptr<Connection> closed = *victim;
  connections_.erase(victim);
  closed->is_closed = true;
  if (closed->end) closed->end();
}

std::shared_ptr<Connection> ConnectionTable::take(const ConnectionOrigin& origin) {
  const int of_network =
      origin.is_loopback ? quota_.loopback_connections_max : quota_.address_connections_max;
  const auto is_of_network = [&](const Connection& one) { return one.origin.network == origin.network; };
  const auto is_remote = [](const Connection& one) { return !one.origin.is_loopback; };
  const auto is_local = [](const Connection& one) { return one.origin.is_loopback; };
  const auto is_any = [](const Connection&) { return true; };
  make_room(of_network, is_of_network, is_of_network);
  if (!origin.is_loopback) make_room(quota_.remote_connections_max, is_remote, is_remote);
  // What other machines may not have is kept for this one: they close none of these.
  const int kept_for_this = quota_.connections_max - quota_.remote_connections_max;
  const bool may_close_local = origin.is_loopback || count_of(is_local) > kept_for_this;
  make_room(quota_.connections_max, is_any, may_close_local ? Test(is_any) : Test(is_remote));
  connections_.push_back(std::make_shared<Connection>(Connection{.origin = origin, .uses = uses_}));
  return connections_.back();
}

void ConnectionTable::give_back(const std::shared_ptr<Connection>& connection) {
  connections_.remove(connection);
}

}  // namespace cell
