#include "cs8_protocol/framing.hpp"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>

#include "tests/cs8_protocol/samples.hpp"

namespace cs8 {
namespace {

namespace asio = boost::asio;

class Framing : public ::testing::Test {
 protected:
  Framing() { asio::local::connect_pair(here_, there_); }

  /// Runs `work` to its end; its exception is thrown here.
  template <class Work>
  void run(Work work) {
    std::exception_ptr failure;
    asio::co_spawn(io_, work(), [&](const std::exception_ptr& thrown) { failure = thrown; });
    io_.run();
    io_.restart();
    if (failure) std::rethrow_exception(failure);
  }

  asio::io_context io_;
  asio::local::stream_protocol::socket here_{io_};
  asio::local::stream_protocol::socket there_{io_};
};

TEST_F(Framing, FramesThatArriveByteByByteAreRead) {
  asio::co_spawn(
      io_,
      [&]() -> asio::awaitable<void> {
        for (const Message& message : one_of_each()) {
          const auto frame = encode(message);
          for (std::size_t i = 0; i < frame.size(); ++i) {
            co_await asio::async_write(there_, asio::buffer(&frame[i], 1), asio::use_awaitable);
            co_await asio::post(io_, asio::use_awaitable);  // let the reader have it
          }
        }
      },
      asio::detached);
  std::size_t read = 0;
  run([&]() -> asio::awaitable<void> {
    for (const Message& message : one_of_each()) {
      const DecodeResult frame = co_await read_frame(here_);
      EXPECT_TRUE(std::holds_alternative<Message>(frame) && same(std::get<Message>(frame), message));
      ++read;
    }
  });
  EXPECT_EQ(read, one_of_each().size());
}

TEST_F(Framing, FramesThatArriveAllAtOnceAreReadOneByOne) {
  std::vector<std::uint8_t> all;
  for (const Message& message : one_of_each()) encode(message, all);
  asio::write(there_, asio::buffer(all));
  std::size_t read = 0;
  run([&]() -> asio::awaitable<void> {
    for (const Message& message : one_of_each()) {
      const DecodeResult frame = co_await read_frame(here_);
      EXPECT_TRUE(std::holds_alternative<Message>(frame) && same(std::get<Message>(frame), message));
      ++read;
    }
  });
  EXPECT_EQ(read, one_of_each().size());
}

TEST_F(Framing, AWrittenFrameIsRead) {
  const Message sent{7, Rejected{RejectReason::kHold, 0}};
  run([&]() -> asio::awaitable<void> {
    co_await write_frame(there_, sent);
    const DecodeResult frame = co_await read_frame(here_);
    EXPECT_TRUE(std::holds_alternative<Message>(frame) && same(std::get<Message>(frame), sent));
  });
}

TEST_F(Framing, ABadHeaderIsRefusedBeforeItsPayloadIsAwaited) {
  auto header = encode({0, Stop{}});
  header[8] = header[9] = 0xff;  // 65535 bytes that never come
  asio::write(there_, asio::buffer(header));
  run([&]() -> asio::awaitable<void> {
    const DecodeResult frame = co_await read_frame(here_);
    const auto* error = std::get_if<DecodeError>(&frame);
    EXPECT_TRUE(error != nullptr && error->kind == DecodeErrorKind::kLength);
  });
}

TEST_F(Framing, AStreamThatEndsAtAnyByteOfAFrameIsEof) {
  for (const Message& message : one_of_each()) {
    const auto frame = encode(message);
    for (std::size_t length = 0; length < frame.size(); ++length) {
      asio::local::stream_protocol::socket reader(io_);
      asio::local::stream_protocol::socket writer(io_);
      asio::local::connect_pair(reader, writer);
      asio::write(writer, asio::buffer(frame.data(), length));
      writer.close();
      boost::system::error_code reason;
      try {
        run([&]() -> asio::awaitable<void> { co_await read_frame(reader); });
      } catch (const boost::system::system_error& error) {
        reason = error.code();
      }
      ASSERT_EQ(reason, asio::error::eof) << "after " << length << " bytes";
    }
  }
}

}  // namespace
}  // namespace cs8
