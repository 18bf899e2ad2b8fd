#include "sim_controller/frame_stream.hpp"

#include <gtest/gtest.h>

#include <random>

#include "cs8_protocol/codec.hpp"

namespace sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes frame(std::uint32_t sequence, cs8::Payload payload) {
  return cs8::encode({sequence, std::move(payload)});
}

Bytes joined(const std::vector<FrameStream::Piece>& pieces) {
  Bytes all;
  for (const FrameStream::Piece& piece : pieces)
    all.insert(all.end(), piece.bytes.begin(), piece.bytes.end());
  return all;
}

TEST(FrameStream, CutsBytesIntoFramesHoweverTheyCome) {
  Bytes all;
  for (std::uint32_t i = 1; i <= 20; ++i) {
    const Bytes next = i % 3 == 0 ? frame(i, cs8::Stop{}) : frame(0, cs8::Heartbeat{i});
    all.insert(all.end(), next.begin(), next.end());
  }
  for (const std::size_t step : {1U, 7U, 64U, 100'000U}) {
    FrameStream stream;
    Bytes seen;
    int messages = 0;
    for (std::size_t at = 0; at < all.size(); at += step) {
      const auto pieces = stream.feed(std::span(all).subspan(at, std::min(step, all.size() - at)));
      for (const FrameStream::Piece& piece : pieces) messages += piece.message.has_value() ? 1 : 0;
      const Bytes more = joined(pieces);
      seen.insert(seen.end(), more.begin(), more.end());
    }
    EXPECT_EQ(messages, 20) << step;
    EXPECT_EQ(seen, all) << step;
    EXPECT_TRUE(stream.take_rest().empty());
  }
}

TEST(FrameStream, KeepsAPartOfAFrameUntilItIsAskedFor) {
  FrameStream stream;
  const Bytes whole = frame(0, cs8::Heartbeat{1});
  EXPECT_TRUE(stream.feed(std::span(whole).first(whole.size() - 1)).empty());
  EXPECT_EQ(stream.take_rest(), Bytes(whole.begin(), whole.end() - 1));
  EXPECT_TRUE(stream.take_rest().empty());
}

TEST(FrameStream, LetsThroughWhatIsNoFrameAndAllBehindIt) {
  FrameStream stream;
  Bytes bytes = frame(0, cs8::Heartbeat{1});
  const Bytes garbage(40, 0x55);
  bytes.insert(bytes.end(), garbage.begin(), garbage.end());
  const auto pieces = stream.feed(bytes);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_TRUE(pieces[0].message);
  EXPECT_FALSE(pieces[1].message);
  EXPECT_EQ(joined(pieces), bytes);
  const Bytes more = frame(0, cs8::Heartbeat{2});
  const auto behind = stream.feed(more);
  ASSERT_EQ(behind.size(), 1U);
  EXPECT_FALSE(behind[0].message);
  EXPECT_EQ(behind[0].bytes, more);
  stream.reset();
  EXPECT_TRUE(stream.feed(more).at(0).message);
}

TEST(FrameStream, AnyBytesComeOutAsTheyWentIn) {
  std::mt19937_64 chance(8);
  for (int round = 0; round < 200; ++round) {
    FrameStream stream;
    Bytes in, out;
    for (int piece = 0; piece < 6; ++piece) {
      Bytes bytes = frame(static_cast<std::uint32_t>(chance()), cs8::Heartbeat{1});
      if (chance() % 3 == 0) bytes[chance() % bytes.size()] = static_cast<std::uint8_t>(chance());
      if (chance() % 4 == 0) bytes.resize(chance() % bytes.size());
      in.insert(in.end(), bytes.begin(), bytes.end());
      const Bytes more = joined(stream.feed(bytes));
      out.insert(out.end(), more.begin(), more.end());
    }
    const Bytes rest = stream.take_rest();
    out.insert(out.end(), rest.begin(), rest.end());
    EXPECT_EQ(in, out);
  }
}

}  // namespace
}  // namespace sim
