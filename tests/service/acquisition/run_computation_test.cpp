#include "service/acquisition/run_computation.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The arithmetic waits until the test lets it.
class RunComputationTest : public ExecutorBench {
 protected:
  /// The operation and the arithmetic in turn, until neither has anything to do.
  void let_both_run() {
    do {
      io.restart();
      io.poll();
      arithmetic_.restart();
    } while (arithmetic_.poll() > 0);
  }

  boost::asio::io_context arithmetic_{1};
  MadeUpAlarm* const alarm_ = new MadeUpAlarm;  // the computation's
  RunComputation withheld_{arithmetic_.get_executor(), regions, status, std::unique_ptr<Alarm>(alarm_)};
  TouchExecutor beside_{cell_of_owners(), withheld_, queue, session,      preparation,
                        block_move,       status,    wake,  time.clocks()};
};

TEST_F(RunComputationTest, TheCommandLeavesBeforeTheResultOfTheTouchesBeforeIt) {
  run(touches_.make_next_touch(active_));
  ASSERT_TRUE(active_.run.identification_is_due());
  boost::asio::co_spawn(io, beside_.make_next_touch(active_), boost::asio::detached);
  io.restart();
  io.poll();
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1", "touch 2"));
  EXPECT_EQ(active_.run.latest().fitted_touch_count, 0);
  let_both_run();
  EXPECT_EQ(active_.run.latest().fitted_touch_count, 1);
  EXPECT_EQ(active_.run.touches_done(), 2);
  expect_run_is_as_stored();
}

TEST_F(RunComputationTest, AResultThatTakesLongIsToldUntilItIsThere) {
  run(touches_.make_next_touch(active_));
  status.warn({FaultCode::kProbeBounced, {}});
  boost::asio::co_spawn(io, beside_.identify(active_), boost::asio::detached);
  io.restart();
  io.poll();
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kProbeBounced) << "it is not late yet";
  EXPECT_EQ(alarm_->set_for, RunComputation::kUntoldMax);
  alarm_->ring();
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kComputationSlow);
  EXPECT_THAT(status.latest().warning->message(), HasSubstr("the result up to touch 1, for 30 s now"));
  EXPECT_EQ(status.state(), State::kExecute) << "it warns only";
  let_both_run();
  EXPECT_EQ(active_.run.latest().fitted_touch_count, 1);
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kProbeBounced) << "as before";
}

TEST_F(RunComputationTest, NoAlarmIsLeftBehindAResultInTime) {
  run(touches_.make_next_touch(active_));
  boost::asio::co_spawn(io, beside_.identify(active_), boost::asio::detached);
  io.restart();
  io.poll();
  EXPECT_TRUE(alarm_->is_set());
  let_both_run();
  EXPECT_FALSE(alarm_->is_set());
  EXPECT_FALSE(status.latest().warning);
}

TEST_F(RunComputationTest, ARunIsConcludedAsOnTheSpot) {
  run(touches_.make_next_touch(active_));
  active_.run.identify();
  const Conclusion there = run(computation.conclude(active_, RunOutcome::kStopped));
  EXPECT_EQ(there.verdict, Verdict::kIncomplete);
  EXPECT_FALSE(there.finished);
  EXPECT_EQ(there.result_json, result_json(active_, regions));
  EXPECT_EQ(there.arm_json, arm_json(active_, cell_of_owners()));
}

}  // namespace
}  // namespace cell
