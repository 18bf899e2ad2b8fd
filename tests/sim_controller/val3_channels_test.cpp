#include "sim_controller/val3_channels.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Peer = Val3Channel::Peer;

Bytes received(Val3Channel& channel, std::size_t most) {
  Bytes bytes(most);
  bytes.resize(channel.receive(bytes));
  return bytes;
}

TEST(Val3Channel, IsActiveFromTheFirstUseAndConnectedWhenAPeerIsThere) {
  Val3Channel channel("Socket\\host");
  EXPECT_FALSE(channel.is_active());
  EXPECT_FALSE(channel.connect());
  EXPECT_TRUE(channel.is_active());
  EXPECT_TRUE(channel.accept());
  EXPECT_TRUE(channel.connect());
  EXPECT_FALSE(channel.accept()) << "a second client";
}

TEST(Val3Channel, AsksForAPeerWhenTheProgramUsesItWithoutOne) {
  Val3Channel channel("Socket\\eye");
  EXPECT_FALSE(channel.take_request());
  channel.connect();
  EXPECT_TRUE(channel.take_request());
  EXPECT_FALSE(channel.take_request()) << "not asked since";
  channel.connect();
  ASSERT_TRUE(channel.accept());
  EXPECT_FALSE(channel.take_request()) << "a peer is there";
  channel.leave();
  channel.connect();
  EXPECT_FALSE(channel.take_request()) << "the program has to close first";
  channel.close();
  channel.connect();
  EXPECT_TRUE(channel.take_request());
  channel.connect();
  channel.close();
  EXPECT_FALSE(channel.take_request()) << "it was given up";
}

TEST(Val3Channel, CarriesBytesBothWays) {
  Val3Channel channel("Socket\\host");
  EXPECT_EQ(channel.give(Bytes{1, 2, 3}), 0U) << "nobody is connected";
  ASSERT_TRUE(channel.accept());
  EXPECT_EQ(channel.give(Bytes{1, 2, 3}), 3U);
  EXPECT_EQ(channel.waiting(), 3U);
  EXPECT_EQ(received(channel, 2), (Bytes{1, 2}));
  EXPECT_EQ(received(channel, 2), (Bytes{3}));
  EXPECT_EQ(channel.send(Bytes{4, 5}), 2U);
  EXPECT_EQ(channel.send(Bytes{6}), 1U);
  EXPECT_EQ(channel.take(), (Bytes{4, 5, 6}));
  EXPECT_TRUE(channel.take().empty());
}

TEST(Val3Channel, TakesNoMoreThanItHasRoomFor) {
  Val3Channel channel("Socket\\host");
  ASSERT_TRUE(channel.accept());
  const Bytes many(Val3Channel::kBufferedMax + 10, 7);
  EXPECT_EQ(channel.give(many), Val3Channel::kBufferedMax);
  EXPECT_EQ(channel.give(Bytes{1}), 0U);
  EXPECT_EQ(channel.send(many), Val3Channel::kBufferedMax);
  EXPECT_EQ(channel.send(Bytes{1}), 0U);
}

TEST(Val3Channel, ThatItsPeerLeftIsReadToItsEndAndHasToBeClosed) {
  Val3Channel channel("Socket\\host");
  ASSERT_TRUE(channel.accept());
  channel.give(Bytes{1, 2});
  channel.leave();
  EXPECT_FALSE(channel.connect());
  EXPECT_EQ(channel.send(Bytes{1}), 0U);
  EXPECT_EQ(received(channel, 8), (Bytes{1, 2}));
  EXPECT_FALSE(channel.accept()) << "the dead connection holds the socket";
  EXPECT_TRUE(channel.close());
  EXPECT_FALSE(channel.close()) << "it was closed already";
  EXPECT_TRUE(channel.accept());
}

TEST(Val3Channel, ThatTheProgramClosesForgetsWhatWasNotRead) {
  Val3Channel channel("Socket\\host");
  ASSERT_TRUE(channel.accept());
  channel.give(Bytes{1, 2});
  EXPECT_TRUE(channel.close());
  EXPECT_EQ(channel.waiting(), 0U);
  EXPECT_EQ(channel.peer(), Peer::kNone);
}

TEST(Val3Channel, AnswersSettingsAsTheManualNumbersThem) {
  Val3Channel channel("Socket\\host");
  const std::string text = "10.0.0.1";
  EXPECT_EQ(channel.set("timeout", -1.0, {}, nullptr), 0);
  EXPECT_EQ(channel.timeout_s(), -1.0);
  EXPECT_EQ(channel.set("clients", 1.0, {}, nullptr), 0);
  EXPECT_EQ(channel.set("nagle", {}, false, nullptr), 0);
  EXPECT_FALSE(channel.nagle());
  EXPECT_EQ(channel.set("endOfString", 10.0, {}, nullptr), 0);
  EXPECT_EQ(channel.end_of_string(), 10);
  EXPECT_EQ(channel.set("port", 11000.0, {}, nullptr), 0);
  EXPECT_EQ(channel.port(), 11000);
  EXPECT_EQ(channel.set("target", {}, {}, &text), 0);
  EXPECT_TRUE(channel.is_client());

  EXPECT_EQ(channel.set("nangle", {}, false, nullptr), -1);
  EXPECT_EQ(channel.set("timeout", {}, {}, &text), -2);
  EXPECT_EQ(channel.set("nagle", 1.0, {}, nullptr), -2);
  for (const double refused : {-2.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(channel.set("timeout", refused, {}, nullptr), -3) << refused;
  EXPECT_EQ(channel.set("endOfString", 256.0, {}, nullptr), -3);
  EXPECT_EQ(channel.set("port", 65'536.0, {}, nullptr), -3);
  for (const double refused : {0.0, 2.0})
    EXPECT_EQ(channel.set("clients", refused, {}, nullptr), -3) << "one peer at a time is simulated";
  EXPECT_EQ(channel.set("baudRate", 9600.0, {}, nullptr), -5);
  ASSERT_TRUE(channel.accept());
  EXPECT_EQ(channel.set("timeout", 1.0, {}, nullptr), -4);
}

TEST(Val3Channel, ASerialPortIsAlwaysThere) {
  Val3Channel channel("Serial\\COM1");
  EXPECT_TRUE(channel.connect());
  EXPECT_EQ(channel.set("baudRate", 9600.0, {}, nullptr), 0);
  EXPECT_EQ(channel.set("port", 1.0, {}, nullptr), -5);
  channel.close();
  EXPECT_TRUE(channel.connect());
}

TEST(Val3Channels, AreOneForALink) {
  Val3Channels channels;
  const auto first = channels.find("Socket\\a");
  ASSERT_TRUE(first);
  EXPECT_EQ(channels.find("Socket\\a"), first);
  EXPECT_NE(channels.find("Socket\\A"), first) << "names are case-sensitive";
  EXPECT_EQ(channels.find(""), std::nullopt);
}

TEST(Val3Channels, AreKnownByTheirLinkOrItsEndWhereOneEndsSo) {
  Val3Channels channels;
  const auto host = channels.find("Socket\\host");
  const auto server = channels.find("Socket\\eye");
  const auto udp = channels.find("UdpSocket\\eye");
  EXPECT_EQ(channels.known("Socket\\host"), host);
  EXPECT_EQ(channels.known("host"), host);
  EXPECT_EQ(channels.known("ost"), std::nullopt);
  EXPECT_EQ(channels.known("eye"), std::nullopt) << "two end so";
  EXPECT_EQ(channels.known("Socket\\eye"), server);
  EXPECT_EQ(channels.known("UdpSocket\\eye"), udp);
  EXPECT_EQ(channels.count(), 3) << "asking makes none";
}

TEST(Val3Channels, AreBounded) {
  Val3Channels channels;
  for (std::size_t i = 0; i < Val3Channels::kChannelsMax; ++i)
    EXPECT_TRUE(channels.find("Socket\\" + std::to_string(i)));
  EXPECT_EQ(channels.find("Socket\\more"), std::nullopt);
}

}  // namespace
}  // namespace sim
