// The application for the real controller against PROTOCOL.md: its files, the handshake, frames, time.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>
#include <regex>

#include "tests/val3/bench.hpp"

namespace val3 {
namespace {

using namespace cs8;

/// The frames that PROTOCOL.md gives as examples.
std::vector<std::vector<std::uint8_t>> golden_frames() {
  std::ifstream page(TOUCHCAL_SOURCE_DIR "/cs8_protocol/PROTOCOL.md");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  static const std::regex block("```hex [^\n]*\n([^`]*)```");
  std::vector<std::vector<std::uint8_t>> frames;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), block); it != std::sregex_iterator(); ++it) {
    std::istringstream words((*it)[1].str());
    std::vector<std::uint8_t>& frame = frames.emplace_back();
    for (std::string word; words >> word;)
      frame.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return frames;
}

Message decoded(const std::vector<std::uint8_t>& frame) {
  const auto header = decode_header(std::span(frame).first<kHeaderSize>());
  return std::get<Message>(decode(std::get<Header>(header), std::span(frame).subspan(kHeaderSize)));
}

template <class Body>
Body golden() {
  for (const auto& frame : golden_frames())
    if (const Message message = decoded(frame); const Body* body = std::get_if<Body>(&message.payload))
      return *body;
  throw std::logic_error("the page has no such frame");
}

TEST(ApplicationLink, WelcomeSaysWhatThePageSays) {
  Bench bench;
  const Welcome welcome = bench.greet();
  const Welcome page = golden<Welcome>();
  EXPECT_EQ(text_of(welcome.application), text_of(page.application));
  EXPECT_EQ(text_of(welcome.arm), text_of(page.arm));
  EXPECT_EQ(welcome.language_version, page.language_version)
      << "from getVersion, " << bench.cabinet.val3_version;
  EXPECT_GT(welcome.application_version, 0u);
  EXPECT_EQ(welcome.last_sequence, 0u);
  EXPECT_EQ(welcome.open_sequence, 0u);
  EXPECT_EQ(welcome.heartbeat_timeout_ms, 500u);
  EXPECT_EQ(welcome.lower_limits, page.lower_limits);
  EXPECT_EQ(welcome.upper_limits, page.upper_limits);
  EXPECT_EQ(welcome.search_length_max_dmm, page.search_length_max_dmm);
  EXPECT_EQ(welcome.search_speed_max_um_s, page.search_speed_max_um_s);
}

TEST(ApplicationLink, HeartbeatTimeoutIsBroughtIntoItsRange) {
  const std::map<std::uint32_t, std::uint32_t> asked{{0, 200}, {100, 200}, {700, 700}, {4000000000u, 2000}};
  for (const auto& [wish, taken] : asked) {
    Bench bench;
    EXPECT_EQ(bench.greet(wish).heartbeat_timeout_ms, taken);
  }
}

TEST(ApplicationLink, ASecondHelloIsAnsweredLikeTheFirst) {
  Bench bench;
  const Welcome first = bench.greet();
  bench.send(0, Hello{700});
  const Welcome second = bench.expect<Welcome>(0);
  EXPECT_EQ(second.session, first.session);
  EXPECT_EQ(second.heartbeat_timeout_ms, 700u);
}

TEST(ApplicationLink, EachOfTheHellosThatComeAtOnceHasItsWelcome) {
  Bench bench;
  ASSERT_TRUE(bench.connect());
  for (int i = 0; i < 3; ++i) bench.send(0, Hello{500});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bench.expect<Welcome>(0).heartbeat_timeout_ms, 500u) << i;
  bench.seconds(0.1);
  EXPECT_TRUE(bench.connected());
}

TEST(ApplicationLink, AnswersBetweenHellosThatComeAtOnceGoAndTheirWelcomesStay) {
  Bench bench;
  bench.greet();
  bench.send(0, ResultQuery{6});
  for (int i = 0; i < 3; ++i) {
    bench.send(0, Hello{500});
    bench.send(0, ResultQuery{7});
  }
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bench.expect<Welcome>(0).heartbeat_timeout_ms, 500u) << i;
  bench.expect<ResultUnknown>(7);
  bench.expect_silence(0.1);
  EXPECT_TRUE(bench.connected());
}

TEST(ApplicationLink, WelcomeNamesTheArmAlsoWhereTheControllerDoesNotSay) {
  Bench::Hardware hardware;
  hardware.differs = [](Cabinet& cabinet) { cabinet.arm_type = ""; };
  Bench bench(hardware);
  EXPECT_EQ(text_of(bench.greet().arm), "tx90");
}

TEST(ApplicationLink, StateComesEvery20MillisecondsFromWelcomeOn) {
  Bench bench;
  bench.heartbeats = false;
  ASSERT_TRUE(bench.connect());
  bench.seconds(0.5);
  EXPECT_EQ(bench.states_seen(), 0) << "before Hello nothing is sent";
  bench.heartbeats = true;
  bench.send(0, Hello{500});
  bench.expect<Welcome>();
  const int before = bench.states_seen();
  bench.seconds(1.0);
  EXPECT_NEAR(bench.states_seen() - before, 50, 1);
  const State state = bench.state();
  EXPECT_EQ(state.mode, WorkingMode::kRemote);
  EXPECT_EQ(state.monitor_speed_percent, 100);
  EXPECT_EQ(state.flags & (kPowered | kHeld | kArmCalibrated | kSettled | kQueueEmpty | kProbeTouched |
                           kRetractDue | kProbeLoopClosed | kTouchTested | kCellClosed),
            kPowered | kArmCalibrated | kSettled | kQueueEmpty | kProbeLoopClosed | kCellClosed);
  EXPECT_EQ(state.joints, bench.at_depth(-20));
  EXPECT_EQ(state.permit, PermitState::kNone);
  EXPECT_EQ(state.task_error, 0) << bench.log();
  EXPECT_EQ(state.overruns, 0u);
}

TEST(ApplicationLink, TakesEveryHostFrameOfThePage) {
  int seen = 0;
  for (const auto& frame : golden_frames()) {
    const Message message = decoded(frame);
    if (is_from_controller(type_of(message))) continue;
    ++seen;
    Bench bench;
    bench.greet();
    bench.send_bytes(frame);
    const auto answer = bench.next(0.5);
    const int type = static_cast<int>(type_of(message));
    EXPECT_TRUE(bench.connected()) << type << '\n' << bench.log();
    if (answer) {
      EXPECT_NE(type_of(*answer), MessageType::kFault) << type;
    }
    if (std::holds_alternative<Touch>(message.payload) || std::holds_alternative<Travel>(message.payload) ||
        std::holds_alternative<Retract>(message.payload)) {
      ASSERT_TRUE(answer) << type;
      EXPECT_EQ(answer->sequence, message.sequence);
      ASSERT_TRUE(std::holds_alternative<Rejected>(answer->payload)) << type;
      EXPECT_EQ(std::get<Rejected>(answer->payload).reason, RejectReason::kNotPermitted);
    }
  }
  EXPECT_EQ(seen, 10) << "one of each kind";
}

TEST(ApplicationLink, FramesArriveByteByByteAndSeveralAtOnce) {
  Bench bench;
  bench.heartbeats = false;
  ASSERT_TRUE(bench.connect());
  for (const std::uint8_t byte : encode({0, Hello{2000}})) {
    bench.send_bytes({byte});
    bench.ticks(1);
  }
  bench.expect<Welcome>();
  std::vector<std::uint8_t> merged;
  for (std::uint32_t i = 5; i < 9; ++i) encode({0, ResultQuery{i}}, merged);
  bench.send_bytes(merged);
  for (std::uint32_t i = 5; i < 9; ++i) EXPECT_EQ(bench.expect<ResultUnknown>(i).command_sequence, i);
  const auto touch = encode({9, bench.touch()});
  for (std::size_t i = 0; i < touch.size(); i += 7) {
    bench.send_bytes({touch.begin() + static_cast<long>(i),
                      touch.begin() + static_cast<long>(std::min(i + 7, touch.size()))});
    bench.ticks(1);
  }
  EXPECT_EQ(bench.expect<Rejected>(9).reason, RejectReason::kNotPermitted);
}

struct Wrong {
  const char* what;
  std::vector<std::uint8_t> bytes;
  FaultCode code;
  std::int32_t detail;
  bool greeted = true;
};

std::vector<Wrong> wrong_frames() {
  const auto changed = [](std::vector<std::uint8_t> frame, std::size_t at, std::uint8_t value) {
    frame.at(at) = value;
    return frame;
  };
  const auto heartbeat = encode({0, Heartbeat{1}});
  Touch touch{};
  touch.via_count = 6;
  Travel travel{};
  travel.via_count = -1;
  return {{"first magic byte", changed(heartbeat, 0, 'X'), FaultCode::kBadMagic, 0},
          {"second magic byte", changed(heartbeat, 1, 0), FaultCode::kBadMagic, 0},
          {"version 1", changed(heartbeat, 2, 1), FaultCode::kVersion, kProtocolVersion},
          {"version 1 in Hello", changed(encode({0, Hello{500}}), 2, 1), FaultCode::kVersion,
           kProtocolVersion, false},
          {"type 0", changed(heartbeat, 3, 0), FaultCode::kUnknownType, 0},
          {"type 200", changed(heartbeat, 3, 200), FaultCode::kUnknownType, 200},
          {"type 11", changed(heartbeat, 3, 11), FaultCode::kUnknownType, 11},
          {"short", changed(heartbeat, 8, 3), FaultCode::kLength, 4},
          {"long by 256", changed(heartbeat, 9, 1), FaultCode::kLength, 4},
          {"of the controller", encode({0, Fault{}}), FaultCode::kWrongSide, 72},
          {"Welcome", encode({0, Welcome{}}), FaultCode::kWrongSide, 65},
          {"six via", encode({1, touch}), FaultCode::kBadValue, 1},
          {"minus one via", encode({1, travel}), FaultCode::kBadValue, 1},
          {"before Hello", heartbeat, FaultCode::kNoHandshake, 0, false}};
}

TEST(ApplicationLink, WrongBytesAreAFaultAndTheEnd) {
  for (const Wrong& wrong : wrong_frames()) {
    SCOPED_TRACE(wrong.what);
    Bench bench;
    bench.heartbeats = false;
    if (wrong.greeted) {
      bench.greet(2000);
    } else {
      ASSERT_TRUE(bench.connect());
    }
    bench.send_bytes(wrong.bytes);
    const Fault fault = bench.expect<Fault>(0);
    EXPECT_EQ(fault.code, wrong.code);
    EXPECT_EQ(fault.detail, wrong.detail);
    const int states = bench.states_seen();
    bench.seconds(0.6);
    EXPECT_EQ(bench.states_seen(), states) << "Fault is the last message";
    EXPECT_FALSE(bench.connected());
    EXPECT_TRUE(bench.connect()) << "the next host is welcome";
    bench.send(0, Hello{500});
    bench.expect<Welcome>();
  }
}

TEST(ApplicationLink, AnyBytesDoNotEndATask) {
  std::mt19937 chance(7);
  for (int round = 0; round < 40; ++round) {
    Bench bench;
    bench.greet(2000);
    auto bytes = encode({3, bench.touch()});
    // a whole frame with a changed byte, then a tail of chance
    bytes[chance() % bytes.size()] = static_cast<std::uint8_t>(chance());
    for (int i = 0; i < 300; ++i) bytes.push_back(static_cast<std::uint8_t>(chance()));
    bench.send_bytes(bytes);
    bench.seconds(0.2);
    bench.disconnect();
    bench.seconds(0.7);
    for (const std::string& task : bench.controller.tasks())
      EXPECT_EQ(bench.controller.machine().task_status(task), 1) << task << '\n' << bench.log();
    EXPECT_EQ(bench.cabinet.pop_ups, 0);
    EXPECT_TRUE(bench.connect());
  }
}

TEST(ApplicationLink, NoHelloWithinTwoSecondsIsTheEnd) {
  Bench bench;
  bench.heartbeats = false;
  ASSERT_TRUE(bench.connect());
  bench.seconds(1.9);
  EXPECT_TRUE(bench.connected());
  bench.seconds(0.7);
  EXPECT_FALSE(bench.connected());
}

TEST(ApplicationLink, ASilentHostIsLeft) {
  Bench bench;
  bench.greet(500);
  bench.seconds(2);
  EXPECT_TRUE(bench.connected());
  bench.heartbeats = false;
  bench.seconds(0.45);
  EXPECT_TRUE(bench.connected());
  bench.seconds(0.7);
  EXPECT_FALSE(bench.connected());
  EXPECT_EQ(bench.greet().heartbeat_timeout_ms, 500u) << "and another may come";
}

TEST(ApplicationLink, AConnectionThatEndsMakesRoomForTheNext) {
  Bench bench;
  const std::uint32_t session = bench.greet().session;
  for (int i = 0; i < 5; ++i) {
    bench.disconnect();
    bench.seconds(0.1);
    EXPECT_EQ(bench.greet().session, session)
        << "the session is that of the application, not of the connection";
  }
}

TEST(ApplicationLink, AFullConnectionDropsStatesButNeverCutsAFrame) {
  Bench bench;
  bench.greet(2000);
  for (std::size_t room = 40; room < 140; room += 7) {
    bench.socket().room = room;
    bench.seconds(0.1);
    bench.socket().room = SIZE_MAX;  // read_frames would complain of anything that is out of step
    const int before = bench.states_seen();
    bench.seconds(0.1);
    EXPECT_GE(bench.states_seen() - before, 4);
  }
  EXPECT_TRUE(bench.connected());
}

TEST(ApplicationLink, ANewStartIsANewSession) {
  Bench bench;
  const std::uint32_t first = bench.greet().session;
  bench.controller.machine().stop();
  bench.seconds(0.5);
  EXPECT_TRUE(bench.controller.tasks().empty()) << testing::PrintToString(bench.controller.tasks());
  bench.disconnect();
  bench.controller.machine().start();
  bench.seconds(0.1);
  EXPECT_EQ(bench.greet().session, first + 1);
}

TEST(ApplicationLink, TheHostIsToldWhenTheApplicationIsEnded) {
  Bench bench;
  bench.greet();
  bench.controller.machine().stop();
  EXPECT_EQ(bench.expect<Fault>(0, 0.5).code, FaultCode::kStopping);
}

}  // namespace
}  // namespace val3
