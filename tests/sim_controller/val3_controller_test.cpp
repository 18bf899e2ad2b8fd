// The application for the real controller in the simulated cell, with a host at its socket; in simulated
// time.
#include "sim_controller/val3_controller.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "bench.hpp"
#include "sim_controller/frame_stream.hpp"
#include "sim_controller/val3/files/read_application.hpp"
#include "sim_controller/val3/language/resolver.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::PermitState;

val3::Application loaded() {
  val3::ReadApplication read =
      val3::read_application(std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "cs8_protocol/val3/touchcal");
  val3::resolve(read.application, read.findings);
  for (const val3::Finding& found : read.findings) {
    if (found.severity == val3::Severity::kError)
      ADD_FAILURE() << found.at.file << ':' << found.at.line << ": " << found.what;
  }
  return std::move(read.application);
}

/// The controller and a host that answers each State with a heartbeat.
class ApplicationCell {
 public:
  explicit ApplicationCell(std::vector<PlannedFault> faults = {}, OperatorDuties duties = {})
      : controller(testing::true_plant("demo"), application_,
                   {.duties = duties, .faults = std::move(faults), .system = {.clock_s = 1000.0}}, findings) {
    EXPECT_TRUE(findings.empty());
    seconds(4.0);  // power comes up
  }

  void tick() {
    const Val3Controller::Brought brought = controller.tick();
    told.insert(told.end(), brought.told.begin(), brought.told.end());
    Val3Channel* channel = controller.host_channel();
    if (channel == nullptr) return;
    const bool is_open = channel->peer() == Val3Channel::Peer::kConnected;
    for (const FrameStream::Piece& piece : from_program_.feed(channel->take())) {
      ASSERT_TRUE(piece.message) << "bytes that are no frame";
      controller.note_sent(*piece.message);
      if (std::holds_alternative<cs8::State>(piece.message->payload)) {
        state = std::get<cs8::State>(piece.message->payload);
        if (is_open && heartbeats) send(0, cs8::Heartbeat{1});
      } else {
        inbox.push_back(*piece.message);
      }
    }
  }
  void seconds(double s) {
    for (int i = 0; i < s / kTickSeconds; ++i) tick();
  }

  void send(std::uint32_t sequence, cs8::Payload payload) {
    const cs8::Message message{sequence, std::move(payload)};
    controller.note_received(message);
    controller.host_channel()->give(cs8::encode(message));
  }

  /// The next message of that kind; those before it are dropped.
  template <class Body>
  Body await(double within_s = 60.0) {
    for (int left = static_cast<int>(within_s / kTickSeconds); left > 0; --left) {
      while (!inbox.empty()) {
        const cs8::Message message = inbox.front();
        inbox.pop_front();
        if (const auto* body = std::get_if<Body>(&message.payload)) return *body;
      }
      tick();
    }
    std::string all;
    for (const std::string& line : told) all += line + '\n';
    ADD_FAILURE() << "no such message within " << within_s << " s\n" << all;
    return {};
  }

  void connect() {
    ASSERT_NE(controller.host_channel(), nullptr);
    from_program_.reset();
    ASSERT_TRUE(controller.host_channel()->accept());
    send(0, cs8::Hello{500});
    await<cs8::Welcome>(1.0);
  }
  /// Asks for a run until somebody confirms it.
  void permit() {
    PermitState now = PermitState::kNone;
    for (int i = 0; i < 100 && now != PermitState::kGranted; ++i) {
      seconds(1.0);
      send(0, cs8::Begin{1, 30'000});
      now = await<cs8::Permit>(1.0).state;
      if (now == PermitState::kAwaited) now = await<cs8::Permit>(31.0).state;
    }
    EXPECT_EQ(now, PermitState::kGranted);
  }
  cs8::TouchResult touch(std::uint32_t sequence) {
    send(sequence, testing::touch_command(motion()));
    await<cs8::Accepted>(1.0);
    const auto result = await<cs8::TouchResult>(200.0);
    send(0, cs8::ResultAcknowledge{sequence});
    return result;
  }
  static const TouchMotion& motion() {
    static const TouchMotion motion = testing::aimed_touch(testing::read_cell("demo"), {}).motion;
    return motion;
  }

 private:
  val3::Application application_ = loaded();
  FrameStream from_program_;

 public:
  val3::Findings findings;
  Val3Controller controller;
  std::deque<cs8::Message> inbox;
  std::vector<std::string> told;
  cs8::State state;
  bool heartbeats = true;
};

TEST(Val3Controller, TakesATouchWhereTheTrueFaceIs) {
  ApplicationCell cell;
  cell.connect();
  cell.permit();
  const cs8::TouchResult result = cell.touch(1);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(result.source, cs8::CaptureSource::kLatched);
  const auto expected = testing::search_contact(cell.controller.plant(), ApplicationCell::motion(),
                                                cell.controller.cabinet().world.noise_m);
  ASSERT_TRUE(expected);
  const double off_m = tip_distance_m(cell.controller.plant(), joints_from_wire(result.contact), *expected);
  EXPECT_LT(off_m, 20e-6);  // a latch step, how the arm came to its stop, the encoders' step
  EXPECT_EQ(cell.touch(2).outcome, Outcome::kContact);
}

TEST(Val3Controller, TouchesOfOneFaceDifferByTheNoiseOfATouch) {
  ApplicationCell cell;
  cell.connect();
  cell.permit();
  std::vector<calib::JointVector> contacts;
  for (std::uint32_t sequence = 1; sequence <= 5; ++sequence)
    contacts.push_back(joints_from_wire(cell.touch(sequence).contact));
  double apart_m = 0.0;
  for (const calib::JointVector& contact : contacts)
    apart_m = std::max(apart_m, tip_distance_m(cell.controller.plant(), contacts.front(), contact));
  EXPECT_GT(apart_m, 5e-6);
  EXPECT_LT(apart_m, 200e-6);
}

TEST(Val3Controller, TheSecondTouchOfACommandAgreesWithItsFirst) {
  ApplicationCell cell;
  cell.connect();
  cell.permit();
  cs8::Touch command = testing::touch_command(ApplicationCell::motion());
  command.second_speed_um_s = 2'000;
  command.second_backoff_dmm = 10'000;
  cell.send(1, command);
  const auto result = cell.await<cs8::TouchResult>(200.0);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  const double apart_m = tip_distance_m(cell.controller.plant(), joints_from_wire(result.first_contact),
                                        joints_from_wire(result.contact));
  EXPECT_LT(apart_m, 3e-6);  // a latch step at each speed
}

TEST(Val3Controller, AHostThatFallsSilentLosesItsConnectionAndTheArmStands) {
  ApplicationCell cell;
  cell.connect();
  cell.permit();
  cell.send(1, testing::touch_command(ApplicationCell::motion()));
  cell.await<cs8::Accepted>(1.0);
  cell.heartbeats = false;
  cell.seconds(1.0);
  EXPECT_NE(cell.controller.host_channel()->peer(), Val3Channel::Peer::kConnected);
  EXPECT_EQ(cell.controller.cabinet().drives.rate, 0.0);
}

TEST(Val3Controller, FaultsOfTheCabinetAndTheProbeComeAsWithTheOtherTwin) {
  const auto outcome_with = [](const InjectedEvent& fault, cs8::Phase phase) {
    ApplicationCell cell({{.what = fault, .on = AtTouch{phase}}});
    cell.connect();
    cell.permit();
    return cell.touch(1).outcome;
  };
  EXPECT_EQ(outcome_with(Act::kEmergencyStop, cs8::Phase::kApproach), Outcome::kPermissionLost);
  EXPECT_EQ(outcome_with(Trouble{TroubleKind::kContactCut}, cs8::Phase::kSearch), Outcome::kProbeFault);
  EXPECT_EQ(outcome_with(Trouble{TroubleKind::kStylusSticks}, cs8::Phase::kSearch), Outcome::kProbeStuck);
  EXPECT_EQ(outcome_with(Trouble{TroubleKind::kVibration, 0, 0.008}, cs8::Phase::kTravel),
            Outcome::kUnexpectedContact);
}

TEST(Val3Controller, ATaskThatDiesEndsTheTouchWithItsNumber) {
  ApplicationCell cell({{.what = Trouble{TroubleKind::kTaskDies, 20}, .on = AtTouch{cs8::Phase::kApproach}}});
  cell.connect();
  cell.permit();
  const cs8::TouchResult result = cell.touch(1);
  EXPECT_EQ(result.outcome, Outcome::kTaskFailed);
  EXPECT_EQ(result.error_number, 20);
}

TEST(Val3Controller, AMoveThatFailsIsAMotionError) {
  ApplicationCell cell(
      {{.what = Trouble{TroubleKind::kMotionError, 150}, .on = AtTouch{cs8::Phase::kApproach}}});
  cell.connect();
  cell.permit();
  EXPECT_EQ(cell.touch(1).outcome, Outcome::kMotionError);
}

TEST(Val3Controller, ARestartIsAnotherSession) {
  ApplicationCell cell;
  cell.connect();
  cell.seconds(0.2);
  const std::uint32_t session = cell.state.session;
  cell.controller.plan().add({.what = Trouble{TroubleKind::kRestarts}});
  cell.seconds(1.0);
  cell.connect();
  cell.seconds(0.2);
  EXPECT_EQ(cell.state.session, session + 1);
}

TEST(Val3Controller, IsBusyWhileTheArmMovesAndThePersonActs) {
  ApplicationCell cell({}, {.powers_up = false});
  EXPECT_FALSE(cell.controller.is_busy());
  cell.controller.plan().add({.what = Act::kPowerOn, .after_s = 1.0});
  EXPECT_TRUE(cell.controller.is_busy());
  cell.seconds(2.0);
  EXPECT_FALSE(cell.controller.is_busy());
  cell.connect();
  EXPECT_TRUE(cell.controller.is_busy()) << "a host says Hello";
  cell.seconds(2.0);
  EXPECT_FALSE(cell.controller.is_busy()) << "heartbeats are no work";
}

}  // namespace
}  // namespace sim
