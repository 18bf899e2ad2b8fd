// What a daemon that is told to end leaves behind.
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <string>

#include "cs8_protocol/names.hpp"
#include "tests/end_to_end/loopback_cell.hpp"

namespace touchcal::testing {
namespace {

namespace asio = boost::asio;
using cell::State;
using cell::Status;

/// Fast enough not to be waited for, slow enough that the arm is met in the middle of a touch.
constexpr double kSpeed = 4.0;

/// As the daemon at a signal.
void end_daemon(LoopbackCell& loop) {
  bool ended = false;
  asio::co_spawn(loop.io(), loop.operation().shut_down(), [&](const std::exception_ptr&) { ended = true; });
  loop.run_until([&](const Status&) { return ended; });
}

class DaemonEnd : public ::testing::TestWithParam<cs8::Phase> {};

TEST_P(DaemonEnd, LeavesTheArmClearOfTheFaceAndTheRunClosed) {
  LoopbackCell loop;
  const sim::Server server(loop.io(), "127.0.0.1", 0, loop.true_plant(), {.controller = {.speed = kSpeed}});
  loop.launch(server.port());
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until([&](const Status&) { return server.report().phase == GetParam(); });
  end_daemon(loop);
  EXPECT_EQ(loop.status().state, State::kStopped);
  EXPECT_EQ(loop.store().run(id)->outcome, cell::RunOutcome::kStopped);
  const cs8::State left = server.report();
  EXPECT_EQ(left.flags & cs8::kRetractDue, 0U) << "a stylus is left at the face";
  EXPECT_TRUE(cs8::probe_inputs(left.flags).free());
  EXPECT_EQ(left.active_sequence, 0U);
}

INSTANTIATE_TEST_SUITE_P(Phases, DaemonEnd,
                         ::testing::Values(cs8::Phase::kTravel, cs8::Phase::kApproach, cs8::Phase::kSearch,
                                           cs8::Phase::kRetract),
                         [](const auto& phase) { return std::string(cs8::name(phase.param)); });

}  // namespace
}  // namespace touchcal::testing
