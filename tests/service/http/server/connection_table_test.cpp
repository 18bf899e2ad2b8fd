#include "service/http/server/connection_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

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

/// Connections with a name each, of which those that were closed are told in their order.
class NamedConnections {
 public:
  explicit NamedConnections(ConnectionTable& table) : table_(table) {}
  void add(char name, const Connection& as, const ConnectionOrigin& origin = kLoopback) {
    const auto connection = table_.take(origin);
    connection->has_requested = as.has_requested;
    connection->token = as.token;
    connection->is_answering = as.is_answering;
    connection->end = [this, name] { closed_ += name; };
    connection->use();
    all_[name] = connection;
  }
  void use(char name) { all_.at(name)->use(); }
  [[nodiscard]] const std::string& closed() const { return closed_; }

 private:
  ConnectionTable& table_;
  std::map<char, std::shared_ptr<Connection>> all_;
  std::string closed_;
};

const Connection kSilent{};
const Connection kViewing{.has_requested = true, .token = TokenRank::kView};
const Connection kOperating{.has_requested = true, .token = TokenRank::kOperate};
const Connection kFollowing{.has_requested = true, .token = TokenRank::kView, .is_answering = true};
const Connection kCommanding{.has_requested = true, .token = TokenRank::kOperate, .is_answering = true};

TEST(ConnectionTable, ThoseWithoutATokenAreClosedFirstThenIdleOnesThatReadThenThatOperateThenTheRest) {
  ConnectionTable table({.connections_max = 7});
  NamedConnections connections(table);
  connections.add('c', kCommanding);
  connections.add('f', kFollowing);
  connections.add('o', kOperating);
  connections.add('v', kViewing);
  connections.add('a', {.has_requested = true, .is_answering = true});
  connections.add('i', {.has_requested = true});
  connections.add('s', kSilent);
  for (int i = 0; i < 7; ++i) connections.add('n', kCommanding);
  EXPECT_EQ(connections.closed(), "siavofc");
  EXPECT_EQ(table.count(), 7u);
}

TEST(ConnectionTable, OfTwoWithTheSameTokenTheOneThatWasIdleLongestIsClosed) {
  ConnectionTable table({.connections_max = 2});
  NamedConnections connections(table);
  connections.add('a', kViewing);
  connections.add('b', kViewing);
  connections.use('a');
  connections.add('c', kViewing);
  EXPECT_EQ(connections.closed(), "b");
}

TEST(ConnectionTable, ANewConnectionAlwaysHasAPlaceUntilItsFirstRequestIsThere) {
  ConnectionTable table({});
  NamedConnections connections(table);
  const std::array<ConnectionOrigin, 2> crowd{origin_of(make_address("127.0.0.2")),
                                              origin_of(make_address("127.0.0.3"))};
  for (int i = 0; i < 600; ++i) connections.add('v', kViewing, crowd.at(static_cast<std::size_t>(i % 2)));
  for (const auto& origin : {origin_of(make_address("127.0.0.9")), remote(1)}) {
    const auto stop = table.take(origin);
    EXPECT_FALSE(stop->is_closed);
    EXPECT_EQ(table.count(), 256u) << "the bound stays";
    stop->has_requested = true;
    stop->token = TokenRank::kOperate;
    for (int i = 0; i < 600; ++i) connections.add('v', kViewing, crowd.at(static_cast<std::size_t>(i % 2)));
    EXPECT_FALSE(stop->is_closed) << "others of less worth go first";
  }
}

TEST(ConnectionTable, OneWithoutARequestYetOutlastsAFloodThatShowsTheViewToken) {
  for (const TokenRank rank : {TokenRank::kView, TokenRank::kNone}) {
    for (const bool is_answering : {false, true}) {
      ConnectionTable table({});
      const auto flood = [&](int count) {
        for (int i = 0; i < count; ++i) {
          const auto one = table.take(kLoopback);
          one->has_requested = true;
          one->token = rank;
          one->is_answering = is_answering;
          one->use();
        }
      };
      flood(600);
      const auto stop = table.take(kLoopback);
      flood(600);
      EXPECT_FALSE(stop->is_closed) << "its bytes may be on their way";
      EXPECT_EQ(table.count(), 224U) << "the bound stays";
    }
  }
}

TEST(ConnectionTable, OfThoseWithoutARequestYetOneInEightPlacesIsSpared) {
  ConnectionTable table({.connections_max = 64});
  NamedConnections connections(table);
  for (int i = 0; i < 64; ++i) connections.add('v', kViewing);
  for (const char name : std::string("abcdefgh")) connections.add(name, kSilent);
  EXPECT_EQ(connections.closed(), "vvvvvvvv");
  connections.add('i', kSilent);
  EXPECT_EQ(connections.closed(), "vvvvvvvvv");
  connections.add('j', kSilent);
  EXPECT_EQ(connections.closed(), "vvvvvvvvva") << "from here on the oldest of them goes";
  connections.add('k', kViewing);
  EXPECT_EQ(connections.closed(), "vvvvvvvvvab");
  connections.add('l', kViewing);
  EXPECT_EQ(connections.closed(), "vvvvvvvvvabv");
}

TEST(ConnectionTable, StrangersCloseNobodyWithAnOperateTokenWhileThereAreOthersOfThem) {
  ConnectionTable table({.connections_max = 16});
  NamedConnections connections(table);
  for (int i = 0; i < 15; ++i) connections.add('o', kOperating);
  for (const char name : std::string("abc")) connections.add(name, kSilent);
  EXPECT_EQ(connections.closed(), "ab");
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
      all.push_back(table.take(remote(machine)));
      all.back()->token = TokenRank::kOperate;
    }
  }
  EXPECT_EQ(table.count(), 8u);
  const auto own = table.take(kLoopback);
  const auto other_own = table.take(kLoopback);
  EXPECT_FALSE(table.take(remote(11))->is_closed);
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
