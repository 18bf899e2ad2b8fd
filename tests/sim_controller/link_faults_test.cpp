// What cs8::Client makes of each fault of the link, and that no touch is lost or made twice.
#include "sim_controller/link_faults.hpp"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <set>

#include "bench.hpp"
#include "cs8_protocol/client.hpp"
#include "sim_controller/fault_names.hpp"
#include "sim_controller/server.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using cs8::LinkErrorKind;
using std::chrono::milliseconds;
using testing::aimed_touch;
using testing::touch_command;

constexpr std::chrono::seconds kRunPatience{20};
/// What the host waits for, in the order of the times.
constexpr cs8::ClientOptions kWaits{.connect_deadline = milliseconds(250),
                                    .heartbeat_period = milliseconds(50),
                                    .heartbeat_timeout = milliseconds(300),
                                    .answer_deadline = milliseconds(600),
                                    .result_margin = milliseconds(100),
                                    .result_lost_after = milliseconds(60'000)};  // what is lost stays lost
constexpr std::uint32_t kTouchDeadlineMs = 600;

/// What the controller knows of the touch that was asked for when the link went, once it is back.
enum class Touch { kNone, kNotMade, kWaits };

struct Case {
  std::string fault;                          // a line of the control connection
  std::optional<LinkErrorKind> lost;          // nothing: the client goes on as if nothing were
  std::optional<Touch> touch = Touch::kNone;  // nothing: it depends on when the fault comes
};

class LinkFaults : public ::testing::Test {
 protected:
  static cs8::Touch touch() {
    static const TouchMotion motion = aimed_touch(testing::read_cell("demo"), {}).motion;
    cs8::Touch command = touch_command(motion);
    command.deadline_ms = kTouchDeadlineMs;
    return command;
  }

  void serve(const std::string& fault) {
    const auto declared = std::get<cell::DeclaredFault>(cell::parse_control_line(fault));
    server_.emplace(io_, "127.0.0.1", 0, testing::true_plant("demo"),
                    ServerOptions{.controller = {.speed = kSpeedMax}, .faults = {planned(declared)}});
  }

  asio::awaitable<cs8::ConnectReply> connect() {
    const Plant plant = testing::true_plant("demo");
    const cs8::ExpectedController expected{.arm = plant.arm_name,
                                           .lower_limits = wire_from_joints(plant.joint_ranges.lower),
                                           .upper_limits = wire_from_joints(plant.joint_ranges.upper)};
    const tcp::endpoint there(asio::ip::address_v4::loopback(), server_->port());
    co_return co_await client_.connect(there, expected);
  }

  /// Until the run is confirmed.
  asio::awaitable<void> make_ready() {
    while (client_.connected()) {
      const cs8::PermitReply reply = co_await client_.begin(1, milliseconds(1000));
      const auto* permit = std::get_if<cs8::Permit>(&reply);
      if (permit == nullptr || permit->state == cs8::PermitState::kGranted) co_return;
      co_await next_state();
    }
  }

  /// Returns at the next State, or when the link is gone.
  asio::awaitable<void> next_state() {
    if (!client_.connected()) co_return;
    state_bell_.expires_at(asio::steady_timer::time_point::max());
    boost::system::error_code rung;
    co_await state_bell_.async_wait(asio::redirect_error(asio::use_awaitable, rung));
  }

  /// Connects, makes three touches and waits for a while; ends with the link.
  asio::awaitable<void> run() {
    const cs8::ConnectReply reply = co_await connect();
    if (const auto* error = std::get_if<cs8::LinkError>(&reply)) {
      lost_ = *error;
      co_return;
    }
    co_await make_ready();
    for (int i = 0; i < 3 && client_.connected(); ++i) {
      const cs8::TouchReply touched = co_await client_.touch(touch());
      asked_ = touched.sequence;
      if (std::holds_alternative<cs8::LinkError>(touched.answer)) co_return;
      outcomes_.push_back(touched.answer);
      client_.acknowledge(touched.sequence);
      asked_ = 0;
    }
    for (int i = 0; i < 5; ++i) co_await next_state();
  }

  /// The link is back, whatever it takes, and the touch is asked for.
  asio::awaitable<Touch> ask() {
    while (std::holds_alternative<cs8::LinkError>(co_await connect())) {
    }
    if (asked_ == 0) co_return Touch::kNone;
    const cs8::QueryReply reply = co_await client_.query(asked_, milliseconds(2000));
    if (std::holds_alternative<cs8::ResultUnknown>(reply)) co_return Touch::kNotMade;
    EXPECT_EQ(std::get<cs8::TouchResult>(reply).outcome, cs8::Outcome::kContact);
    co_return Touch::kWaits;
  }

  void meet(const Case& link_case) {
    if (HasFatalFailure()) return;  // something of the case before may still run
    SCOPED_TRACE(link_case.fault);
    io_.restart();
    lost_.reset();
    outcomes_.clear();
    asked_ = 0;
    serve(link_case.fault);
    bool done = false;
    std::exception_ptr failure;
    Touch touch = Touch::kNone;
    asio::co_spawn(
        io_,
        [&]() -> asio::awaitable<void> {
          co_await run();
          if (lost_) touch = co_await ask();
        },
        [&](std::exception_ptr error) {
          failure = error;
          done = true;
          client_.close();
          server_->stop();
        });
    io_.run_for(kRunPatience);
    if (failure) std::rethrow_exception(failure);
    ASSERT_TRUE(done) << "waits for something that does not come";
    ASSERT_EQ(lost_.has_value(), link_case.lost.has_value()) << (lost_ ? lost_->text : "goes on");
    if (link_case.touch) {
      EXPECT_EQ(touch, *link_case.touch);
    }
    if (lost_) {
      EXPECT_EQ(lost_->kind, *link_case.lost) << lost_->text;
    } else {
      EXPECT_EQ(outcomes_.size(), 3U);
    }
  }

  void meet_all(const std::vector<Case>& cases) {
    for (const Case& link_case : cases) meet(link_case);
  }

  asio::io_context io_;
  asio::steady_timer state_bell_{io_};
  std::optional<Server> server_;
  cs8::Client client_{io_.get_executor(),
                      kWaits,
                      {.on_state = [this](const cs8::State&) { state_bell_.cancel(); },
                       .on_loss =
                           [this](const cs8::LinkError& error) {
                             lost_ = error;
                             state_bell_.cancel();
                           }}};
  std::optional<cs8::LinkError> lost_;
  std::vector<decltype(cs8::TouchReply::answer)> outcomes_;
  std::uint32_t asked_ = 0;  // the touch that was not answered
};

TEST_F(LinkFaults, AtTheConnection) {
  meet_all({{R"({"fault":"close","on":"connection"})", LinkErrorKind::kPeerClosed},
            {R"({"fault":"go_silent","on":"connection"})", LinkErrorKind::kHandshakeTimeout},
            {R"({"fault":"half_open","on":"connection"})", LinkErrorKind::kHandshakeTimeout},
            {R"({"fault":"garbage","on":"connection"})", LinkErrorKind::kProtocol},
            {R"({"fault":"stop_states","on":"connection"})", LinkErrorKind::kSilent}});
}

TEST_F(LinkFaults, InTheHandshake) {
  meet_all({{R"({"fault":"drop","on":"hello"})", LinkErrorKind::kHandshakeTimeout},
            {R"({"fault":"close","on":"hello"})", LinkErrorKind::kPeerClosed},
            {R"({"fault":"drop","on":"welcome"})", LinkErrorKind::kProtocol},
            {R"({"fault":"close_mid_frame","on":"welcome"})", LinkErrorKind::kPeerClosed},
            {R"({"fault":"half_open","on":"welcome"})", LinkErrorKind::kHandshakeTimeout},
            {R"({"fault":"garbage","on":"welcome"})", LinkErrorKind::kProtocol},
            {R"({"fault":"wrong_version","on":"welcome"})", LinkErrorKind::kIncompatible},
            {R"({"fault":"unknown_type","on":"welcome"})", LinkErrorKind::kProtocol},
            {R"({"fault":"bad_length","on":"welcome"})", LinkErrorKind::kProtocol},
            {R"({"fault":"bad_value","on":"welcome"})", LinkErrorKind::kProtocol},
            {R"({"fault":"wrong_arm","on":"welcome"})", LinkErrorKind::kIncompatible},
            {R"({"fault":"wrong_application","on":"welcome"})", LinkErrorKind::kIncompatible},
            {R"({"fault":"wrong_limits","on":"welcome"})", LinkErrorKind::kIncompatible},
            {R"({"fault":"wrong_session","on":"welcome"})", LinkErrorKind::kProtocol},
            {R"({"fault":"delay","on":"hello","ms":230})", {}},
            {R"({"fault":"delay","on":"hello","ms":270})", LinkErrorKind::kHandshakeTimeout}});
}

TEST_F(LinkFaults, AtATouch) {
  meet_all(
      {{R"({"fault":"close","on":"touch","count":2})", LinkErrorKind::kPeerClosed, Touch::kNotMade},
       {R"({"fault":"drop","on":"touch","count":2})", LinkErrorKind::kUnanswered, Touch::kNotMade},
       {R"({"fault":"duplicate","on":"touch","count":2})", {}},
       {R"({"fault":"delay","on":"touch","count":2,"ms":580})", {}},
       {R"({"fault":"delay","on":"touch","count":2,"ms":620})", LinkErrorKind::kUnanswered, Touch::kNotMade},
       {R"({"fault":"wrong_sequence","on":"touch","count":2})", LinkErrorKind::kProtocol, Touch::kNotMade},
       {R"({"fault":"half_open","on":"touch","count":2})", LinkErrorKind::kSilent, Touch::kNotMade},
       {R"({"fault":"go_silent","on":"touch","count":2})", LinkErrorKind::kSilent, Touch::kWaits},
       {R"({"fault":"garbage","on":"touch","count":2})", LinkErrorKind::kProtocol, Touch::kNotMade}});
}

TEST_F(LinkFaults, AtItsAcceptance) {
  meet_all(
      {{R"({"fault":"close","on":"accepted","count":2})", LinkErrorKind::kPeerClosed, Touch::kWaits},
       {R"({"fault":"close_mid_frame","on":"accepted","count":2})", LinkErrorKind::kPeerClosed,
        Touch::kWaits},
       {R"({"fault":"half_open","on":"accepted","count":2})", LinkErrorKind::kSilent, Touch::kWaits},
       {R"({"fault":"drop","on":"accepted","count":2})", {}},
       {R"({"fault":"duplicate","on":"accepted","count":2})", {}},
       {R"({"fault":"delay","on":"accepted","count":2,"ms":580})", {}},
       {R"({"fault":"delay","on":"accepted","count":2,"ms":620})", LinkErrorKind::kUnanswered, Touch::kWaits},
       {R"({"fault":"wrong_sequence","on":"accepted","count":2})", LinkErrorKind::kProtocol, Touch::kWaits},
       {R"({"fault":"wrong_version","on":"accepted","count":2})", LinkErrorKind::kProtocol, Touch::kWaits}});
}

TEST_F(LinkFaults, AtItsResult) {
  const std::vector<std::pair<std::string, LinkErrorKind>> losses{
      {"close", LinkErrorKind::kPeerClosed},        {"close_mid_frame", LinkErrorKind::kPeerClosed},
      {"half_open", LinkErrorKind::kSilent},        {"go_silent", LinkErrorKind::kSilent},
      {"drop", LinkErrorKind::kUnanswered},         {"garbage", LinkErrorKind::kProtocol},
      {"wrong_sequence", LinkErrorKind::kProtocol}, {"wrong_version", LinkErrorKind::kProtocol},
      {"unknown_type", LinkErrorKind::kProtocol},   {"bad_length", LinkErrorKind::kProtocol},
      {"bad_value", LinkErrorKind::kProtocol}};
  for (const auto& [fault, lost] : losses) {
    meet({R"({"fault":")" + fault + R"(","on":"touch_result","count":2})", lost, Touch::kWaits});
  }
  meet_all({{R"({"fault":"duplicate","on":"touch_result","count":"every"})", {}},
            {R"({"fault":"delay","on":"touch_result","count":2,"ms":680})", {}},
            {R"({"fault":"delay","on":"touch_result","count":2,"ms":720})", LinkErrorKind::kUnanswered,
             Touch::kWaits}});
}

TEST_F(LinkFaults, ThatOnlyShapeTheStreamAreNotNoticed) {
  for (const std::string fault : {"byte_by_byte", "merge"}) {
    for (const std::string on : {"welcome", "state", "accepted", "touch_result"}) {
      const std::string count = on == "state" && fault == "merge" ? "2" : "\"every\"";
      meet({R"({"fault":")" + fault + R"(","on":")" + on + R"(","count":)" + count + "}", {}});
    }
  }
}

TEST_F(LinkFaults, AtAState) {  // states come by the clock: which touch is open then is not known
  meet_all({{R"({"fault":"drop","on":"state","count":3})", {}},
            {R"({"fault":"drop","on":"state","count":"every"})", LinkErrorKind::kSilent, std::nullopt},
            {R"({"fault":"duplicate","on":"state","count":"every"})", {}},
            {R"({"fault":"stop_states","on":"state","count":2})", LinkErrorKind::kSilent, std::nullopt},
            {R"({"fault":"stop_states","on":"state","count":2,"ms":200})", {}},
            {R"({"fault":"wrong_session","on":"state","count":2})", LinkErrorKind::kProtocol, std::nullopt},
            {R"({"fault":"garbage","on":"state","count":2})", LinkErrorKind::kProtocol, std::nullopt},
            {R"({"fault":"half_open","on":"state","count":2})", LinkErrorKind::kSilent, std::nullopt}});
}

TEST_F(LinkFaults, AtTheAcknowledgement) {
  meet({R"({"fault":"duplicate","on":"result_acknowledge","count":"every"})", {}});
  meet({R"({"fault":"drop","on":"result_acknowledge","count":1})", {}});
  ASSERT_EQ(outcomes_.size(), 3U);
  EXPECT_EQ(std::get<cs8::Rejected>(outcomes_[1]).reason, cs8::RejectReason::kResultUnacknowledged);
}

TEST_F(LinkFaults, AResultUnderAnotherTouchsNumberIsNotTheLinksToNotice) {
  meet({R"({"fault":"stale_result","on":"touch_result","count":2})", {}});
  const auto joints = [this](std::size_t i) { return std::get<cs8::TouchResult>(outcomes_.at(i)).contact; };
  EXPECT_EQ(joints(0), joints(1));
  EXPECT_NE(joints(0), joints(2));
  meet({R"({"fault":"wrong_joints","on":"touch_result","count":2})", {}});
  EXPECT_GT(std::abs(joints(1)[0] - joints(0)[0]), 10'000'000);
}

TEST_F(LinkFaults, AnApplicationThatIsEndedAtThePendantEndsTheConnectionAndItsSession) {
  meet({R"({"fault":"restart","touch":2})", LinkErrorKind::kPeerClosed, Touch::kNotMade});
}

TEST_F(LinkFaults, AHostThatIsNotHeardIsLeft) {
  serve(R"({"fault":"drop","on":"heartbeat","count":"every"})");
  bool done = false;
  asio::co_spawn(
      io_,
      [&]() -> asio::awaitable<void> {
        co_await connect();
        while (client_.connected()) co_await next_state();
      },
      [&](std::exception_ptr) {
        done = true;
        server_->stop();
      });
  io_.run_for(kRunPatience);
  ASSERT_TRUE(done);
  EXPECT_EQ(lost_.value().kind, LinkErrorKind::kPeerClosed);
}

TEST_F(LinkFaults, APortThatNobodyListensAtIsListenedAtAgain) {
  meet({R"({"fault":"refuse","on":"hello","ms":300})", {}});  // the connection that is there stays
  serve(R"({"fault":"refuse","ms":300})");
  std::vector<LinkErrorKind> kinds;
  bool done = false;
  io_.restart();
  asio::co_spawn(
      io_,
      [&]() -> asio::awaitable<void> {
        server_->inject({Fault::kCloseSocket, cs8::MessageType::kState});
        co_await connect();
        while (client_.connected()) co_await next_state();
        for (;;) {
          const cs8::ConnectReply reply = co_await connect();
          if (const auto* error = std::get_if<cs8::LinkError>(&reply)) {
            kinds.push_back(error->kind);
          } else {
            co_return;
          }
        }
      },
      [&](std::exception_ptr) {
        done = true;
        client_.close();
        server_->stop();
      });
  io_.run_for(kRunPatience);
  ASSERT_TRUE(done);
  ASSERT_FALSE(kinds.empty());
  EXPECT_EQ(std::set(kinds.begin(), kinds.end()), std::set{LinkErrorKind::kUnreachable});
}

}  // namespace
}  // namespace sim
