// What INSTALL.md promises for the first run, and small promises of the page that a commissioning would meet.
#include <gtest/gtest.h>

#include "cs8_protocol/names.hpp"
#include "tests/val3/touch_steps.hpp"

namespace val3 {
namespace {

using namespace cs8;

/// Runs one tick at a time until the touch answers; the deepest place on the way.
double deepest_mm(Bench& bench, TouchResult& result, double& seconds) {
  double deepest = bench.depth_mm();
  const double begin_s = bench.cabinet.now_s;
  for (int left = 100000; left > 0; --left) {
    const auto message = bench.next(kTickSeconds);
    deepest = std::max(deepest, bench.depth_mm());
    if (!message) continue;
    if (const auto* answer = std::get_if<TouchResult>(&message->payload)) {
      result = *answer;
      break;
    }
  }
  seconds = bench.cabinet.now_s - begin_s;
  return deepest;
}

TEST(ApplicationCommissioning, ADryRunGoesSlowlyToEachApproachAndTouchesNothing) {
  double usual_s = 0;
  double dry_s = 0;
  TouchResult result;
  {
    Bench bench;
    bench.make_ready();
    bench.send(1, bench.touch());
    EXPECT_NEAR(deepest_mm(bench, result, usual_s), 20, 0.1) << "there is no face";
  }
  Bench bench;
  bench.controller.machine().set_truth("kDryRun", true);
  bench.make_ready();
  bench.send(1, bench.touch());
  EXPECT_NEAR(deepest_mm(bench, result, dry_s), 0, 0.1);
  EXPECT_EQ(result.outcome, Outcome::kNoContact) << name(result.outcome);
  EXPECT_EQ(result.source, CaptureSource::kNone);
  EXPECT_EQ(bench.state().flags & kRetractDue, 0u);
  // clear to approach and back are 40 mm at a tenth of 20 mm/s
  EXPECT_GT(dry_s, 20.0);
  EXPECT_LT(usual_s, 10.0);
}

/// Whether the application starts its tasks on a controller that is otherwise as `differs` says.
bool starts(std::function<void(Cabinet&)> differs) {
  Bench bench({.differs = std::move(differs)});
  const bool runs = bench.controller.machine().task_status("receive") == 1;
  EXPECT_EQ(bench.cabinet.pop_ups, runs ? 0 : 1);
  return runs;
}

TEST(ApplicationCommissioning, StartsOnTheVersionsThatItIsMadeFor) {
  const auto version = [](const char* text) { return [text](Cabinet& c) { c.val3_version = text; }; };
  EXPECT_TRUE(starts(version("s7.7.2 - Mar 23 2012 - 16:01:17")));
  EXPECT_TRUE(starts(version("s7.7.2")));
  EXPECT_TRUE(starts(version("s7.11.1 - Sep 27 2016 - 16:01:17")));
  EXPECT_TRUE(starts(version("s8.1")));
  EXPECT_FALSE(starts(version("s7.7 - Sep 27 2011 - 16:01:17"))) << "that is s7.7.0";
  EXPECT_FALSE(starts(version("s7.7 - Sep 27 2011 b1.9"))) << "a point behind the version is none of it";
  EXPECT_FALSE(starts(version("s6.8.1 - Sep 27 2007 - 16:01:17")));
  EXPECT_FALSE(starts(version("")));
}

TEST(ApplicationCommissioning, StartsOnItsArmOnly) {
  const auto arm = [](const char* type) { return [type](Cabinet& c) { c.arm_type = type; }; };
  EXPECT_TRUE(starts(arm("tx90-S1")));
  EXPECT_TRUE(starts(arm("tx90")));
  EXPECT_TRUE(starts(arm(""))) << "a controller that does not say";
  EXPECT_FALSE(starts(arm("tx90l-S1")));
  EXPECT_FALSE(starts(arm("rx160")));
  Bench bench;
  EXPECT_NE(bench.log().find("arm tx90-S1, serial F09_9EF3A1_A_01"), std::string::npos) << bench.log();
}

TEST(ApplicationCommissioning, StartsOnAnArmWhoseNameHasAHyphen) {
  const std::map<std::string, bool> cases{
      {"tx2-90", true}, {"tx2-90-S1", true}, {"tx2-90l-S1", false}, {"tx2-60", false}, {"tx2", false}};
  for (const auto& [type, fits] : cases) {
    Bench bench;
    bench.controller.machine().stop();
    bench.seconds(0.2);
    bench.cabinet.arm_type = type;
    bench.controller.machine().set_text("kArm", "tx2-90");
    bench.controller.machine().start();
    bench.seconds(0.1);
    EXPECT_EQ(bench.controller.machine().task_status("receive") == 1, fits) << type << '\n' << bench.log();
    if (fits) {
      EXPECT_EQ(bench.controller.machine().text("sArm"), "tx2-90") << type;
    }
  }
}

TEST(ApplicationCommissioning, SetsItsSocketAndDoesNotStartWithoutThat) {
  Bench bench;
  EXPECT_EQ(bench.socket().timeout_s, -1);
  EXPECT_EQ(bench.socket().clients, 1);
  EXPECT_FALSE(bench.socket().nagle);
  const auto refuses = [](const char* name, double answer) {
    return [=](Cabinet& c) { c.socket_refuses[name] = answer; };
  };
  EXPECT_FALSE(starts(refuses("timeout", -3)));
  EXPECT_FALSE(starts(refuses("clients", -5)));
  EXPECT_FALSE(starts(refuses("nagle", -3)));
  EXPECT_TRUE(starts(refuses("nagle", -1))) << "a version that does not know the name: the pendant's setting";
}

TEST(ApplicationCommissioning, ItsTimesAndNumbersGoOnBeyond32Bits) {
  Bench bench({.clock_s = 5e6});  // 58 days: 5e9 milliseconds
  bench.make_ready();
  const auto now_ms = static_cast<std::uint32_t>(std::llround(bench.cabinet.now_s * 1000));  // modulo 2^32
  EXPECT_LE(bench.state().clock_ms - now_ms, 40u);
  EXPECT_EQ(bench.variable<double>("nTaskError"), 0);
}

TEST(ApplicationCommissioning, EdgesAreCountedToStandstillOnly) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  bench.send(1, bench.touch());
  bench.expect<Accepted>(1);
  // the stylus bounces on its way back
  for (int left = 10000; bench.state().phase != Phase::kRetract && left > 0; --left) bench.ticks(1);
  for (int i = 0; i < 3; ++i) {
    bench.wires.contact = true;
    bench.wires.loop = false;
    bench.ticks(2);
    bench.wires.contact.reset();
    bench.wires.loop.reset();
    bench.ticks(2);
  }
  const TouchResult result = bench.expect<TouchResult>(1, 30);
  EXPECT_EQ(result.outcome, Outcome::kContact) << name(result.outcome);
  EXPECT_EQ(result.edges, 1u);
}

TEST(ApplicationCommissioning, ABentStylusIsBroughtBackWithAPersonsWord) {
  Bench bench;
  bench.face_mm = kFaceMm;
  bench.make_ready();
  bench.send(1, bench.touch());
  bench.expect<Accepted>(1);
  for (int left = 5000; bench.depth_mm() < kFaceMm && left > 0; --left) bench.ticks(1);
  bench.disconnect();
  bench.seconds(1);
  bench.greet();
  bench.send(0, ResultAcknowledge{1});
  EXPECT_NE(bench.state().flags & kRetractDue, 0u);
  EXPECT_NE(bench.state().flags & kProbeTouched, 0u);
  bench.make_ready();
  bench.send(2, bench.touch());
  EXPECT_EQ(bench.expect<Rejected>(2).reason, RejectReason::kRetractPending);
  expect_way_back(bench, 2);
}

TEST(ApplicationCommissioning, AHostThatAsksFasterThanItIsAnsweredIsAnsweredAllTheSame) {
  Bench bench;
  bench.greet();
  constexpr std::uint32_t kQuestions = 200;
  for (std::uint32_t i = 1; i <= kQuestions; ++i) bench.send(0, ResultQuery{i});
  for (std::uint32_t i = 1; i <= kQuestions; ++i)
    ASSERT_EQ(bench.expect<ResultUnknown>(i).command_sequence, i) << bench.log();
}

TEST(ApplicationCommissioning, AHostThatDoesNotReadIsDropped) {
  Bench bench;
  bench.greet();
  bench.socket().room = 0;
  for (std::uint32_t i = 1; i <= 200; ++i) bench.send(0, ResultQuery{i});
  bench.seconds(1);
  EXPECT_FALSE(bench.connected());
  EXPECT_EQ(bench.variable<double>("nTaskError"), 0);
}

}  // namespace
}  // namespace val3
