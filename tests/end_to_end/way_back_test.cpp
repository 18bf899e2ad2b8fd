// A touch that is broken off may leave the stylus at a face. One confirmation of a person covers the way back
// and then the run: the way back is the first motion, and before it nothing moves.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "cs8_protocol/codec.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/relay.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;
using cell::Status;
using cs8::MessageType;

/// The touch that is broken off; those before it are made in peace.
constexpr int kBroken = 5;

/// What breaks a touch off, by its name in a line of the control connection, and what people do against it.
struct Cause {
  std::string fault;
  std::string expected;  // fault code
  std::vector<std::string> remedies;
};

void PrintTo(const Cause& cause, std::ostream* out) { *out << cause.fault; }

class WayBack : public ::testing::TestWithParam<std::tuple<Cause, std::string>> {
 protected:
  WayBack() {
    loop_.serve();
    relay_.emplace(loop_.io(), loop_.port(), [this](const cs8::Message& message) { note(message); });
    loop_.launch(relay_->port());
    loop_.run_until(State::kIdle);
  }

  [[nodiscard]] static const Cause& cause() { return std::get<0>(GetParam()); }

  /// A run whose touch is broken off by the cause in the phase, on hold, with its link, and the way back
  /// told.
  std::int64_t break_off() {
    loop_.inject(R"({"fault":")" + cause().fault + R"(","touch":)" + std::to_string(kBroken) +
                 R"(,"phase":")" + std::get<1>(GetParam()) + R"("})");
    const std::int64_t id = loop_.start();
    loop_.run_until_over();
    EXPECT_EQ(loop_.status().state, State::kHeld);
    EXPECT_EQ(loop_.fault_name(), cause().expected);
    loop_.run_until([](const Status& status) { return status.controller.retract_due == true; });
    asked_.clear();
    granted_count_ = 0;
    return id;
  }

  void take_cause_away() {
    for (const std::string& remedy : cause().remedies) loop_.inject(R"({"fault":")" + remedy + R"("})");
  }

  LoopbackCell loop_;
  std::vector<MessageType> asked_;  // each Begin and each motion
  int granted_count_ = 0;

 private:
  void note(const cs8::Message& message) {
    const MessageType type = cs8::type_of(message);
    const bool is_motion =
        type == MessageType::kTouch || type == MessageType::kTravel || type == MessageType::kRetract;
    if (is_motion && granted_count_ == 0) moved_unconfirmed_ = true;
    if (is_motion || type == MessageType::kBegin) asked_.push_back(type);
    const auto* permit = std::get_if<cs8::Permit>(&message.payload);
    if (permit && permit->state == cs8::PermitState::kGranted) ++granted_count_;
  }

 protected:
  std::optional<Relay> relay_;
  bool moved_unconfirmed_ = false;
};

TEST_P(WayBack, IsTheFirstMotionBehindTheOneConfirmationThatTheRunGoesOnWith) {
  const std::int64_t id = break_off();
  take_cause_away();
  EXPECT_THAT(asked_, ::testing::IsEmpty());
  loop_.command(Command::kResume);
  loop_.run_until_touches(kBroken + 1);
  EXPECT_FALSE(moved_unconfirmed_);
  EXPECT_EQ(granted_count_, 1);
  // A Begin that the cell is not ready for is refused and repeated.
  const auto first =
      std::ranges::find_if(asked_, [](MessageType type) { return type != MessageType::kBegin; });
  EXPECT_NE(first, asked_.begin());
  const std::vector<MessageType> moved(first, asked_.end());
  ASSERT_GE(moved.size(), 2U);
  EXPECT_EQ(moved[0], MessageType::kRetract);
  EXPECT_THAT(std::vector(moved.begin() + 1, moved.end()), ::testing::Each(MessageType::kTouch));
  EXPECT_EQ(loop_.status().controller.retract_due, false);
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  expect_touches_once(loop_, id, kShortTouchCount);
}

std::string name_of(const ::testing::TestParamInfo<std::tuple<Cause, std::string>>& info) {
  return std::get<0>(info.param).fault + "_in_" + std::get<1>(info.param);
}

const auto kPhases = ::testing::Values("approach", "search", "retract");

INSTANTIATE_TEST_SUITE_P(
    Causes, WayBack,
    ::testing::Combine(::testing::Values(Cause{"close", "link_lost", {}},
                                         Cause{"emergency_stop",
                                               "permission_lost",
                                               {"release_emergency_stop", "acknowledge_emergency_stop",
                                                "power_on"}},
                                         Cause{"power_off", "permission_lost", {"power_on"}}),
                       kPhases),
    name_of);

// Behind an opened door the stylus is tested once more by hand, which a face that holds it does not allow:
// there a person jogs the arm free, and no way back is due.
INSTANTIATE_TEST_SUITE_P(Door, WayBack,
                         ::testing::Combine(::testing::Values(Cause{
                                                "open_cell", "permission_lost", {"close_cell"}}),
                                            ::testing::Values("search")),
                         name_of);

}  // namespace
}  // namespace touchcal::testing
