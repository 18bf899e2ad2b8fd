#include "sim_controller/server.hpp"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <functional>

#include "bench.hpp"
#include "cs8_protocol/framing.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using testing::aimed_touch;
using testing::touch_command;

/// No test waits longer than this for bytes; on a loaded machine it is far more than they take.
constexpr std::chrono::seconds kAnswerPatience{10};

/// A raw connection to the server.
class Host {
 public:
  Host(asio::io_context& io, std::uint16_t port) : socket_(io) {
    socket_.connect({asio::ip::address_v4::loopback(), port});
  }

  asio::awaitable<void> send(std::uint32_t sequence, cs8::Payload payload) {
    co_await cs8::write_frame(socket_, {sequence, std::move(payload)});
  }

  asio::awaitable<void> send_bytes(std::vector<std::uint8_t> bytes) {
    co_await asio::async_write(socket_, asio::buffer(bytes), asio::use_awaitable);
  }

  /// The next message that is not a State; the decode error of a frame that is none throws.
  asio::awaitable<cs8::Message> next() {
    for (;;) {
      const cs8::DecodeResult frame = co_await cs8::read_frame(socket_);
      const auto& message = std::get<cs8::Message>(frame);
      if (!std::holds_alternative<cs8::State>(message.payload)) co_return message;
    }
  }

  template <class Payload>
  asio::awaitable<Payload> next_as() {
    const cs8::Message message = co_await next();
    co_return std::get<Payload>(message.payload);
  }

  asio::awaitable<cs8::Welcome> greet() {
    co_await send(0, cs8::Hello{2000});
    co_return co_await next_as<cs8::Welcome>();
  }

  /// Greets and asks for a run until it is confirmed.
  asio::awaitable<void> permit() {
    co_await greet();
    for (;;) {
      const cs8::Begin begin{1, 30'000};
      co_await send(0, begin);
      cs8::Permit told = co_await next_as<cs8::Permit>();
      if (told.state == cs8::PermitState::kAwaited) told = co_await next_as<cs8::Permit>();
      if (told.state == cs8::PermitState::kGranted) co_return;
      co_await cs8::read_frame(socket_);  // a State: time has passed
    }
  }

  /// True when the connection ends without another message.
  asio::awaitable<bool> ends() {
    try {
      co_await next();
    } catch (const boost::system::system_error&) {
      co_return true;
    }
    co_return false;
  }

  void close() { socket_.close(); }

 private:
  tcp::socket socket_;
};

class ServerTest : public ::testing::Test {
 protected:
  static const TouchMotion& motion() {
    static const TouchMotion motion = aimed_touch(testing::read_cell("demo"), {}).motion;
    return motion;
  }
  static cs8::Touch touch() { return touch_command(motion()); }

  void serve(std::vector<PlannedFault> faults = {}, double speed = kSpeedMax) {
    server_.emplace(io_, "127.0.0.1", 0, testing::true_plant("demo"),
                    ServerOptions{.controller = {.speed = speed}, .faults = std::move(faults)});
  }

  Host host() { return {io_, server_->port()}; }

  /// Runs the script to its end; what it throws fails the test.
  void play(std::function<asio::awaitable<void>()> script) {
    std::exception_ptr failure;
    bool done = false;
    asio::co_spawn(io_, std::move(script), [&](std::exception_ptr error) {
      failure = error;
      done = true;
      server_->stop();
    });
    io_.run_for(kAnswerPatience);
    if (failure) std::rethrow_exception(failure);
    ASSERT_TRUE(done) << "the script waits for bytes that do not come";
  }

  asio::io_context io_;
  std::optional<Server> server_;
};

TEST_F(ServerTest, ATouchGoesOverTheWire) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Host host = this->host();
    co_await host.permit();
    co_await host.send(1, touch());
    co_await host.next_as<cs8::Accepted>();
    const cs8::Message result = co_await host.next();
    EXPECT_EQ(result.sequence, 1u);
    EXPECT_EQ(std::get<cs8::TouchResult>(result.payload).outcome, cs8::Outcome::kContact);
  });
}

TEST_F(ServerTest, ASecondHostIsToldSoAndTheFirstStays) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Host first = host();
    co_await first.permit();
    Host second = host();
    EXPECT_EQ((co_await second.next_as<cs8::Fault>()).code, cs8::FaultCode::kOccupied);
    EXPECT_TRUE(co_await second.ends());
    co_await first.send(1, touch());
    co_await first.next_as<cs8::Accepted>();
  });
}

TEST_F(ServerTest, ThePlaceIsFreeWhenTheHostIsGone) {
  serve();
  play([this]() -> asio::awaitable<void> {
    for (int i = 0; i < 3; ++i) {
      Host host = this->host();
      // Until the server has seen the end of the one before, it says that it is occupied.
      co_await host.send(0, cs8::Hello{2000});
      const cs8::Message answer = co_await host.next();
      if (!std::holds_alternative<cs8::Welcome>(answer.payload)) --i;
    }
  });
}

TEST_F(ServerTest, BytesThatAreNoFrameGetTheirFaultAndTheNextHostIsServed) {
  serve();
  play([this]() -> asio::awaitable<void> {
    struct Case {
      std::vector<std::uint8_t> bytes;
      cs8::FaultCode code;
    };
    std::vector<std::uint8_t> other_version = cs8::encode({0, cs8::Hello{500}});
    other_version[2] = 9;
    std::vector<std::uint8_t> unknown_type = cs8::encode({0, cs8::Hello{500}});
    unknown_type[3] = 63;
    std::vector<std::uint8_t> wrong_length = cs8::encode({0, cs8::Hello{500}});
    wrong_length[8] = 200;
    std::vector<std::uint8_t> bad_count = cs8::encode({1, touch()});
    bad_count[10] = 99;
    const auto greeted_first = [](const std::vector<std::uint8_t>& bytes) {
      std::vector<std::uint8_t> both = cs8::encode({0, cs8::Hello{500}});
      both.insert(both.end(), bytes.begin(), bytes.end());
      return both;
    };
    const std::vector<Case> cases{
        {std::vector<std::uint8_t>(100'000, 'x'), cs8::FaultCode::kBadMagic},
        {other_version, cs8::FaultCode::kVersion},
        {unknown_type, cs8::FaultCode::kUnknownType},
        {wrong_length, cs8::FaultCode::kLength},
        {cs8::encode({1, touch()}), cs8::FaultCode::kNoHandshake},
        {cs8::encode({1, cs8::Welcome{}}), cs8::FaultCode::kNoHandshake},
        {bad_count, cs8::FaultCode::kNoHandshake},
        {greeted_first(cs8::encode({1, cs8::Welcome{}})), cs8::FaultCode::kWrongSide},
        {greeted_first(bad_count), cs8::FaultCode::kBadValue},
    };
    for (const Case& bad : cases) {
      Host host = this->host();
      co_await host.send_bytes(bad.bytes);
      cs8::Message told = co_await host.next();
      if (std::holds_alternative<cs8::Welcome>(told.payload)) told = co_await host.next();
      EXPECT_EQ(std::get<cs8::Fault>(told.payload).code, bad.code);
      EXPECT_TRUE(co_await host.ends());
    }
    Host good = host();
    co_await good.greet();
  });
}

TEST_F(ServerTest, AHostThatLeavesInTheMiddleOfATouchFindsItStopped) {
  serve({}, 20.0);
  play([this]() -> asio::awaitable<void> {
    {
      Host first = host();
      co_await first.permit();
      co_await first.send(1, touch());
      co_await first.next_as<cs8::Accepted>();
    }
    for (;;) {
      Host again = host();
      co_await again.send(0, cs8::Hello{2000});
      const cs8::Message answer = co_await again.next();
      if (!std::holds_alternative<cs8::Welcome>(answer.payload)) continue;
      EXPECT_EQ(std::get<cs8::Welcome>(answer.payload).open_sequence, 1u);
      co_await again.send(0, cs8::ResultQuery{1});
      cs8::Message found = co_await again.next();
      if (std::holds_alternative<cs8::Accepted>(found.payload)) found = co_await again.next();  // it brakes
      EXPECT_EQ(std::get<cs8::TouchResult>(found.payload).outcome, cs8::Outcome::kHeartbeatLost);
      co_return;
    }
  });
}

TEST_F(ServerTest, PlannedFaultsHappenAtTheirMessage) {
  using cs8::MessageType;
  struct Case {
    PlannedFault planned;
    bool connection_ends;
  };
  for (const Case& planned : {Case{{Fault::kCloseSocket, MessageType::kTouch, 2}, true},
                              Case{{Fault::kCloseSocket, MessageType::kTouchResult, 2}, true},
                              Case{{Fault::kGarbage, MessageType::kTouchResult, 2}, false},
                              Case{{Fault::kWrongSequence, MessageType::kTouchResult, 2}, false},
                              Case{{Fault::kDrop, MessageType::kTouchResult, 2}, false}}) {
    io_.restart();
    serve({planned.planned});
    play([this, &planned]() -> asio::awaitable<void> {
      Host host = this->host();
      co_await host.permit();
      co_await host.send(1, touch());
      co_await host.next_as<cs8::Accepted>();
      EXPECT_EQ((co_await host.next()).sequence, 1u);
      co_await host.send(0, cs8::ResultAcknowledge{1});
      co_await host.send(2, touch());
      if (planned.connection_ends) {
        if (std::get<MessageType>(planned.planned.on) == MessageType::kTouchResult)
          co_await host.next_as<cs8::Accepted>();
        EXPECT_TRUE(co_await host.ends());
        co_return;
      }
      co_await host.next_as<cs8::Accepted>();
      switch (std::get<LinkFault>(planned.planned.what).kind) {
        case Fault::kGarbage:
          try {
            co_await host.next();
            ADD_FAILURE() << "garbage was a message";
          } catch (const std::bad_variant_access&) {
          }
          break;
        case Fault::kWrongSequence:
          EXPECT_EQ((co_await host.next()).sequence, 2u + kSequenceOffset);
          break;
        default:  // dropped: the query brings it
          co_await host.send(0, cs8::ResultQuery{3});
          co_await host.next_as<cs8::ResultUnknown>();
          co_await host.send(0, cs8::ResultQuery{2});
          EXPECT_EQ((co_await host.next()).sequence, 2u);
      }
    });
  }
}

TEST_F(ServerTest, ASilentControllerSendsNothingAndServesTheNextHost) {
  serve({{Fault::kGoSilent, cs8::MessageType::kTouch, 1}});
  play([this]() -> asio::awaitable<void> {
    {
      Host host = this->host();
      co_await host.permit();
      co_await host.send(1, touch());
      co_await host.send(0,
                         cs8::Hello{200});  // no answer; after 200 ms the controller hears nothing and closes
      EXPECT_TRUE(co_await host.ends());
    }
    Host again = host();
    EXPECT_EQ((co_await again.greet()).open_sequence, 1u);
  });
}

TEST_F(ServerTest, GoesBeforeItsIoContextDoes) {
  serve();
  Host left = host();
  server_.reset();
  io_.run_for(kAnswerPatience);
  EXPECT_TRUE(io_.stopped()) << "something of the server stayed";
}

}  // namespace
}  // namespace sim
