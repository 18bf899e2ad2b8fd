// A VAL3 application behind a real socket, as fast as it can.
#include "sim_controller/val3_server.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "bench.hpp"
#include "cell_with_stand.hpp"
#include "cs8_protocol/framing.hpp"
#include "sim_controller/control.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// No test waits longer than this for bytes; on a loaded machine it is far more than they take.
constexpr std::chrono::seconds kScriptPatience{60};

const val3::Application& touchcal() {
  static const val3::Application application = [] {
    val3::ReadApplication read =
        val3::read_application(std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "cs8_protocol/val3/touchcal");
    val3::resolve(read.application, read.findings);
    return std::move(read.application);
  }();
  return application;
}

/// A raw connection that answers each State with a heartbeat.
class Val3Host {
 public:
  Val3Host(asio::io_context& io, std::uint16_t port) : socket_(io) {
    socket_.connect({asio::ip::address_v4::loopback(), port});
  }

  asio::awaitable<void> send(std::uint32_t sequence, cs8::Payload payload) {
    co_await cs8::write_frame(socket_, {sequence, std::move(payload)});
  }
  asio::awaitable<void> send_bytes(std::vector<std::uint8_t> bytes) {
    co_await asio::async_write(socket_, asio::buffer(bytes), asio::use_awaitable);
  }

  /// The next message of that kind; those before it are dropped.
  template <class Body>
  asio::awaitable<Body> await_message() {
    for (;;) {
      const cs8::DecodeResult frame = co_await cs8::read_frame(socket_);
      const cs8::Message message = std::get<cs8::Message>(frame);
      if (message.payload.index() == cs8::Payload(cs8::State{}).index()) co_await send(0, cs8::Heartbeat{1});
      if (const auto* body = std::get_if<Body>(&message.payload)) co_return *body;
    }
  }

  asio::awaitable<cs8::Welcome> greet() {
    co_await send(0, cs8::Hello{2000});
    co_return co_await await_message<cs8::Welcome>();
  }

  asio::awaitable<void> permit() {
    for (;;) {
      const cs8::Begin begin{1, 30'000};
      co_await send(0, begin);
      cs8::Permit told = co_await await_message<cs8::Permit>();
      if (told.state == cs8::PermitState::kAwaited) told = co_await await_message<cs8::Permit>();
      if (told.state == cs8::PermitState::kGranted) co_return;
      co_await await_message<cs8::State>();
    }
  }

  /// True when the connection ends, whatever comes before.
  asio::awaitable<bool> ends() {
    try {
      for (;;) co_await cs8::read_frame(socket_);
    } catch (const boost::system::system_error&) {
      co_return true;
    }
  }

  void close() { socket_.close(); }

 private:
  tcp::socket socket_;
};

class Val3ServerTest : public ::testing::Test {
 protected:
  void serve(std::vector<PlannedFault> faults = {}) {
    val3::Findings findings;
    server_.emplace(io_, "127.0.0.1", 0, testing::true_plant("demo"), touchcal(),
                    Val3ServerOptions{.controller = {.faults = std::move(faults),
                                                     .plants = make_plants(testing::cell_with_stand(), {})},
                                      .speed = kSpeedMax},
                    findings);
    EXPECT_TRUE(findings.empty());
  }
  Val3Host host() { return {io_, server_->port()}; }
  static cs8::Touch touch() {
    return testing::touch_command(testing::aimed_touch(testing::read_cell("demo"), {}).motion);
  }

  /// Runs the script to its end; what it throws fails the test.
  void play(std::function<asio::awaitable<void>()> script) {
    std::exception_ptr failure;
    bool done = false;
    asio::co_spawn(io_, std::move(script), [&](std::exception_ptr error) {
      failure = error;
      done = true;
      server_->stop();
    });
    io_.run_for(kScriptPatience);
    if (failure) std::rethrow_exception(failure);
    ASSERT_TRUE(done) << "the script waits for bytes that do not come";
  }

  asio::io_context io_;
  std::optional<Val3Server> server_;
};

TEST_F(Val3ServerTest, ATouchGoesOverTheWire) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Val3Host host = this->host();
    const cs8::Welcome welcome = co_await host.greet();
    EXPECT_EQ(cs8::text_of(welcome.application), "touchcal");
    co_await host.permit();
    co_await host.send(1, touch());
    co_await host.await_message<cs8::Accepted>();
    const auto result = co_await host.await_message<cs8::TouchResult>();
    EXPECT_EQ(result.outcome, cs8::Outcome::kContact);
    EXPECT_EQ(result.source, cs8::CaptureSource::kLatched);
  });
}

TEST_F(Val3ServerTest, ASecondHostIsTurnedAwayAndTheNextOneServed) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Val3Host first = host();
    co_await first.greet();
    Val3Host second = host();
    EXPECT_TRUE(co_await second.ends());
    co_await first.await_message<cs8::State>();
    first.close();
    Val3Host third = host();
    const cs8::Welcome welcome = co_await third.greet();
    EXPECT_EQ(welcome.open_sequence, 0U);
  });
}

TEST_F(Val3ServerTest, BytesThatAreNoFrameReachTheApplicationAndItEndsTheConnection) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Val3Host host = this->host();
    co_await host.send_bytes(std::vector<std::uint8_t>(40, 0x55));
    const auto fault = co_await host.await_message<cs8::Fault>();
    EXPECT_EQ(fault.code, cs8::FaultCode::kBadMagic);
    EXPECT_TRUE(co_await host.ends());
  });
}

TEST_F(Val3ServerTest, ASilentHostIsLeftWhileTheArmMoves) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Val3Host host = this->host();
    co_await host.send(0, cs8::Hello{200});
    co_await host.await_message<cs8::Welcome>();
    co_await host.permit();
    co_await host.send(1, touch());
    EXPECT_TRUE(co_await host.ends());
    Val3Host next = this->host();
    const cs8::Welcome welcome = co_await next.greet();
    EXPECT_EQ(welcome.open_sequence, 1U) << "its result waits";
  });
}

TEST_F(Val3ServerTest, LinkFaultsMeetWholeFrames) {
  serve({{.what = LinkFault(Fault::kDrop), .on = cs8::MessageType::kWelcome},
         {.what = LinkFault(Fault::kWrongArm), .on = cs8::MessageType::kWelcome, .nth = 2},
         {.what = LinkFault(Fault::kCloseSocket), .on = cs8::MessageType::kBegin}});
  play([this]() -> asio::awaitable<void> {
    Val3Host host = this->host();
    co_await host.send(0, cs8::Hello{2000});
    co_await host.await_message<cs8::State>();
    const cs8::Welcome welcome = co_await host.greet();
    EXPECT_NE(cs8::text_of(welcome.arm), "tx90");
    const cs8::Begin begin{1, 30'000};
    co_await host.send(0, begin);
    EXPECT_TRUE(co_await host.ends());
  });
}

TEST_F(Val3ServerTest, TheControlConnectionActsOnIt) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Val3Host host = this->host();
    co_await host.greet();
    co_await host.permit();
    EXPECT_NE(answer_control_line(*server_, R"({"fault": "emergency_stop"})").find("true"),
              std::string::npos);
    while ((co_await host.await_message<cs8::State>()).emergency_stop == 0) continue;
    EXPECT_EQ(server_->report().emergency_stop, 2);
    EXPECT_TRUE(server_->jog({}).has_value()) << "without power";
  });
}

TEST_F(Val3ServerTest, ABlockThatWasBroughtToItsStandIsTouchedThere) {
  serve();
  play([this]() -> asio::awaitable<void> {
    Val3Host host = this->host();
    co_await host.greet();
    co_await host.permit();
    EXPECT_EQ(answer_control_line(*server_, R"({"block":"stand"})"), R"({"ok":true})");
    co_await host.send(1, testing::touch_command(testing::touch_on_stand(2).motion));
    co_await host.await_message<cs8::Accepted>();
    EXPECT_NE(answer_control_line(*server_, R"({"block":"first"})").find("the arm moves"), std::string::npos);
    const auto result = co_await host.await_message<cs8::TouchResult>();
    EXPECT_EQ(result.outcome, cs8::Outcome::kContact);
  });
}

}  // namespace
}  // namespace sim
