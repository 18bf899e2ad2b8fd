#include "service/http/server/connection_table.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

using boost::asio::ip::make_address;

const ConnectionOrigin kLoopback = origin_of(make_address("127.0.0.1"));

ConnectionOrigin remote(int machine) { return origin_of(make_address("192.0.2." + std::to_string(machine))); }

TEST(ConnectionOrigin, AnIpv6NetworkIsOneOriginAndAnIpv4AddressIsOneInBothFamilies) {
  const auto network = [](const char* address) { return origin_of(make_address(address)).network; };
  EXPECT_EQ(network("2001:db8::1"), network("2001:db8::ffff:1"));
  EXPECT_NE(network("2001:db8::1"), network("2001:db8:0:1::1"));
  EXPECT_EQ(network("::ffff:192.0.2.1"), network("192.0.2.1"));
  EXPECT_NE(network("192.0.2.1"), network("192.0.2.2"));
  EXPECT_TRUE(origin_of(make_address("::1")).is_loopback);
  EXPECT_TRUE(origin_of(make_address("::ffff:127.0.0.1")).is_loopback);
  EXPECT_FALSE(origin_of(make_address("2001:db8::1")).is_loopback);
}

TEST(ConnectionTable, SilentOnesAreClosedFirstThenIdleThenAnsweringAndNeverOneWithAToken) {
  ConnectionTable table({.connections_max = 4});
  std::string closed;
  const auto add = [&](char name, const Connection& as) {
    const auto connection = table.take(kLoopback);
    if (!connection) return false;
    connection->has_requested = as.has_requested;
    connection->has_token = as.has_token;
    connection->is_answering = as.is_answering;
    connection->end = [&closed, name] { closed += name; };
    return true;
  };
  const Connection with_token{.has_requested = true, .has_token = true};
  EXPECT_TRUE(add('t', with_token));
  EXPECT_TRUE(add('a', {.has_requested = true, .is_answering = true}));
  EXPECT_TRUE(add('i', {.has_requested = true}));
  EXPECT_TRUE(add('s', {}));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(add('t', with_token));
  EXPECT_EQ(closed, "sia");
  EXPECT_FALSE(add('n', {})) << "full of those with a token";
  EXPECT_EQ(table.count(), 4u);
}

TEST(ConnectionTable, ThePlaceOfAConnectionThatEndedIsFreeOnce) {
  ConnectionTable table({.connections_max = 1});
  const auto first = table.take(kLoopback);
  const auto second = table.take(kLoopback);
  EXPECT_TRUE(first->is_closed);
  table.give_back(first);
  EXPECT_EQ(table.count(), 1u) << "its place is that of the second";
  table.give_back(second);
  EXPECT_EQ(table.count(), 0u);
}

TEST(ConnectionTable, OtherMachinesLeavePlacesForThisOne) {
  ConnectionTable table({.connections_max = 10, .remote_connections_max = 8, .address_connections_max = 2});
  std::vector<std::shared_ptr<Connection>> all;
  for (int machine = 1; machine <= 10; ++machine) {
    for (int i = 0; i < 2; ++i) {
      if (auto connection = table.take(remote(machine))) {
        connection->has_token = true;
        all.push_back(connection);
      }
    }
  }
  EXPECT_EQ(all.size(), 8u);
  const auto own = table.take(kLoopback);
  const auto other_own = table.take(kLoopback);
  EXPECT_TRUE(own && other_own);
  EXPECT_FALSE(table.take(remote(11)));
  EXPECT_FALSE(own->is_closed || other_own->is_closed) << "another machine closes none of this one";
}

TEST(ConnectionTable, OneAddressClosesOnlyItsOwn) {
  ConnectionTable table({.address_connections_max = 2});
  const auto other = table.take(remote(1));
  const auto first = table.take(remote(2));
  const auto second = table.take(remote(2));
  const auto third = table.take(remote(2));
  EXPECT_TRUE(third);
  EXPECT_TRUE(first->is_closed);
  EXPECT_FALSE(second->is_closed || other->is_closed);
}

}  // namespace
}  // namespace cell
