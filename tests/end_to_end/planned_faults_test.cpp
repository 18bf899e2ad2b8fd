// A whole run in a cell where something goes wrong at a message or in a touch: what the operator reads, and
// that no touch is lost or counted twice.
#include <gtest/gtest.h>

#include <vector>

#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

/// All faults come with this touch; those before it are made in peace.
constexpr int kFaulty = 5;

class PlannedFaults : public ::testing::Test {
 protected:
  PlannedFaults() {
    loop_.cell.deadlines.command = std::chrono::milliseconds(500);
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
  }

  /// A run with the fault; its id.
  std::int64_t run_with(const std::string& fault) {
    loop_.inject(fault);
    const std::int64_t id = loop_.start();
    loop_.run_until_over();
    return id;
  }

  void mend(const std::vector<std::string>& mends) {
    for (const std::string& mend : mends) loop_.inject(mend);
  }

  LoopbackCell loop_;
};

// A stylus that a face holds cannot be tested by hand, and a controller that started anew knows no way back:
// there the operator moves the arm.

/// A fault, what the operator reads of it, how many touches are in the store once the controller was asked,
/// and what people do against it.
struct Case {
  const char* fault;
  const char* expected;  // fault code
  int made = kFaulty - 1;
  std::vector<std::string> mends;
};

/// The run is over, and the next one is whole when people have mended what was wrong.
class Aborted : public PlannedFaults, public ::testing::WithParamInterface<Case> {};

TEST_P(Aborted, ARunSaysWhyAndTheNextOneIsWhole) {
  SCOPED_TRACE(GetParam().fault);
  const std::int64_t id = run_with(GetParam().fault);
  EXPECT_EQ(loop_.status().state, State::kAborted);
  EXPECT_EQ(loop_.fault_name(), GetParam().expected) << loop_.status().fault->message();
  EXPECT_EQ(loop_.store().run(id)->fault_code, GetParam().expected);
  EXPECT_EQ(loop_.store().run(id)->verdict, cell::Verdict::kIncomplete);
  expect_touches_once(loop_, id, kFaulty - 1);

  mend(GetParam().mends);
  loop_.leave_aborted();
  expect_touches_once(loop_, id, GetParam().made);
  const std::int64_t next = loop_.start();
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, next, kShortTouchCount);
  expect_touches_once(loop_, id, GetParam().made);
}

INSTANTIATE_TEST_SUITE_P(
    Probe, Aborted,
    ::testing::Values(Case{R"({"fault":"touch_stylus","touch":5,"phase":"approach"})",
                           "unexpected_contact",
                           kFaulty - 1,
                           {R"({"fault":"release_stylus"})"}},
                      Case{R"({"fault":"vibration","touch":5,"phase":"travel","ms":1,"after_ms":40})",
                           "unexpected_contact"}));

INSTANTIATE_TEST_SUITE_P(Controller, Aborted,
                         ::testing::Values(Case{R"({"fault":"motion_error","touch":5,"error":120})",
                                                "motion_error"},
                                           Case{R"({"fault":"never_settles","touch":5})",
                                                "motion_error",
                                                kFaulty - 1,
                                                {R"({"fault":"settles"})"}},
                                           Case{R"({"fault":"collision","touch":5})", "collision"},
                                           Case{R"({"fault":"wrong_joints","on":"touch_result","count":5})",
                                                "implausible_touch"}));

/// The run waits with the fault and goes on when the cause is gone.
class Held : public PlannedFaults, public ::testing::WithParamInterface<Case> {};

TEST_P(Held, ARunWaitsForAPersonAndGoesOn) {
  SCOPED_TRACE(GetParam().fault);
  const std::int64_t id = run_with(GetParam().fault);
  EXPECT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.fault_name(), GetParam().expected);
  expect_touches_once(loop_, id, GetParam().made);
  mend(GetParam().mends);
  loop_.command(Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

INSTANTIATE_TEST_SUITE_P(AtTouchFive, Held,
                         ::testing::Values(Case{R"({"fault":"probe_stuck","touch":5})",
                                                "probe_stuck",
                                                kFaulty - 1,
                                                {R"({"fault":"probe_mended"})"}}));

INSTANTIATE_TEST_SUITE_P(Cable, Held,
                         ::testing::Values(Case{R"({"fault":"contact_cut","touch":5})",
                                                "probe_fault",
                                                kFaulty - 1,
                                                {R"({"fault":"probe_mended"})", R"({"fault":"jog_home"})"}},
                                           Case{R"({"fault":"contact_short","touch":5,"phase":"travel"})",
                                                "probe_fault",
                                                kFaulty - 1,
                                                {R"({"fault":"probe_mended"})"}},
                                           Case{R"({"fault":"loop_cut","touch":5,"phase":"approach"})",
                                                "probe_fault",
                                                kFaulty - 1,
                                                {R"({"fault":"probe_mended"})"}},
                                           Case{R"({"fault":"loop_short","touch":5})",
                                                "probe_fault",
                                                kFaulty - 1,
                                                {R"({"fault":"probe_mended"})", R"({"fault":"jog_home"})"}}));

INSTANTIATE_TEST_SUITE_P(
    People, Held,
    ::testing::Values(
        Case{R"({"fault":"hold","touch":5})", "permission_lost", kFaulty - 1, {R"({"fault":"move"})"}},
        Case{R"({"fault":"references_lost","touch":5})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"references_found"})"}},
        Case{R"({"fault":"power_off","touch":5})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"power_on"})"}},
        Case{R"({"fault":"emergency_stop","touch":5})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"release_emergency_stop"})", R"({"fault":"acknowledge_emergency_stop"})",
              R"({"fault":"power_on"})"}},
        Case{R"({"fault":"manual_mode","touch":5})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"remote_mode"})", R"({"fault":"power_on"})"}},
        Case{R"({"fault":"local_mode","touch":5,"phase":"retract"})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"remote_mode"})", R"({"fault":"power_on"})"}},
        Case{R"({"fault":"open_cell","touch":5})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"close_cell"})"}},
        Case{R"({"fault":"jog_home","touch":5})",
             "permission_lost",
             kFaulty - 1,
             {R"({"fault":"remote_mode"})", R"({"fault":"power_on"})"}}));

/// The run waits with its touches and the link comes back by itself; `made` is what is stored once the
/// controller was asked.
class BrokenOff : public PlannedFaults, public ::testing::WithParamInterface<Case> {
 protected:
  /// Where a link is open and nothing comes any more, a busy machine may miss the answer before the
  /// heartbeat.
  [[nodiscard]] bool is_told() const {
    const std::string told = loop_.fault_name();
    const bool is_half_open = std::string_view(GetParam().fault).find("half_open") != std::string_view::npos;
    return told == GetParam().expected || (is_half_open && told == "answer_missing");
  }
};

TEST_P(BrokenOff, ARunWaitsWithItsTouchesAndGoesOn) {
  SCOPED_TRACE(GetParam().fault);
  const std::int64_t id = run_with(GetParam().fault);
  EXPECT_EQ(loop_.status().state, State::kHeld);
  EXPECT_GE(loop_.status().touches_done, kFaulty - 1);
  // Where nothing is heard any more, that there is no State is told first.
  loop_.run_until([this](const cell::Status&) { return is_told(); });
  mend(GetParam().mends);
  loop_.run_until([](const cell::Status& status) { return !status.controller.connected; });
  loop_.run_until([](const cell::Status& status) {
    return status.controller.connected && status.touches_done >= GetParam().made;
  });
  EXPECT_TRUE(is_told()) << "until a person resumes: " << loop_.fault_name();
  expect_touches_once(loop_, id, GetParam().made);
  loop_.command(Command::kResume);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

INSTANTIATE_TEST_SUITE_P(
    Link, BrokenOff,
    ::testing::Values(
        Case{R"({"fault":"close","touch":5})", "link_lost"},
        Case{R"({"fault":"close","touch":5,"phase":"travel","after_ms":40})", "link_lost"},
        Case{R"({"fault":"close_mid_frame","on":"accepted","count":5})", "link_lost", kFaulty},
        Case{R"({"fault":"close_mid_frame","on":"touch_result","count":5})", "link_lost", kFaulty},
        Case{R"({"fault":"half_open","on":"touch_result","count":5})", "link_lost", kFaulty},
        Case{R"({"fault":"half_open","on":"touch","count":5})", "link_lost"},
        Case{R"({"fault":"wrong_version","on":"touch_result","count":5})", "protocol_error", kFaulty},
        Case{R"({"fault":"unknown_type","on":"touch_result","count":5})", "protocol_error", kFaulty},
        Case{R"({"fault":"bad_length","on":"touch_result","count":5})", "protocol_error", kFaulty},
        Case{R"({"fault":"bad_value","on":"touch_result","count":5})", "protocol_error", kFaulty}));

INSTANTIATE_TEST_SUITE_P(Controller, BrokenOff,
                         ::testing::Values(Case{R"({"fault":"task_dies","touch":5,"error":150})",
                                                "task_failed",
                                                kFaulty - 1,
                                                {R"({"fault":"restart"})", R"({"fault":"jog_home"})"}},
                                           Case{R"({"fault":"restart","touch":5})",
                                                "link_lost",
                                                kFaulty - 1,
                                                {R"({"fault":"jog_home"})"}}));

class Unhurt : public PlannedFaults, public ::testing::WithParamInterface<const char*> {};

TEST_P(Unhurt, ARunIsWhole) {
  SCOPED_TRACE(GetParam());
  const std::int64_t id = run_with(GetParam());
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

INSTANTIATE_TEST_SUITE_P(
    By, Unhurt,
    ::testing::Values(R"({"fault":"duplicate","on":"touch","count":"every"})",
                      R"({"fault":"duplicate","on":"accepted","count":5})",
                      R"({"fault":"duplicate","on":"touch_result","count":"every"})",
                      R"({"fault":"duplicate","on":"result_acknowledge","count":"every"})",
                      R"({"fault":"byte_by_byte","on":"touch_result","count":"every"})",
                      R"({"fault":"merge","on":"accepted","count":"every"})",
                      R"({"fault":"delay","on":"touch","count":5,"ms":50})",
                      R"({"fault":"delay","on":"touch_result","count":5,"ms":50})",
                      R"({"fault":"drop","on":"state","count":5})",
                      R"({"fault":"stale_result","on":"touch_result","count":5})",
                      R"({"fault":"probe_bounces","touch":"every","times":3})",
                      R"({"fault":"latch_lost","touch":5})", R"({"fault":"overruns","touch":5,"times":3})",
                      R"({"fault":"press_confirm","touch":5})"));

TEST_F(PlannedFaults, AControllerThatComesBackAsAnotherOneIsRefused) {
  for (const std::string fault : {"wrong_arm", "wrong_application", "wrong_limits", "wrong_version"}) {
    SCOPED_TRACE(fault);
    loop_.inject(R"({"fault":")" + fault + R"(","on":"welcome"})");
    loop_.inject(R"({"fault":"close"})");
    loop_.run_until([this](const cell::Status&) { return loop_.fault_name() == "controller_incompatible"; });
    EXPECT_EQ(loop_.status().state, State::kResetting);
    loop_.run_until(State::kIdle);  // the next welcome is right again
    EXPECT_TRUE(loop_.fault_name().empty());
  }
}

TEST_F(PlannedFaults, APortThatNobodyListensAtIsTriedUntilSomebodyDoes) {
  loop_.inject(R"({"fault":"refuse","ms":300})");
  loop_.inject(R"({"fault":"close"})");
  loop_.run_until([this](const cell::Status&) { return loop_.fault_name() == "controller_unreachable"; });
  loop_.run_until(State::kIdle);
}

}  // namespace
}  // namespace touchcal::testing
