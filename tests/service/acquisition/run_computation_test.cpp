#include "service/acquisition/run_computation.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;

/// The arithmetic waits until the test lets it.
class RunComputationTest : public ExecutorBench {
 protected:
  boost::asio::io_context arithmetic_{1};
  RunComputation withheld_{arithmetic_.get_executor(), cell_of_owners()};
  TouchExecutor beside_{cell_of_owners(), withheld_, queue, session,
                        preparation,      status,    wake,  time.clocks()};
};

TEST_F(RunComputationTest, TheCommandLeavesBeforeTheResultOfTheTouchesBeforeIt) {
  run(touches_.make_next_touch(active_));
  ASSERT_TRUE(active_.run.identification_is_due());
  boost::asio::co_spawn(io, beside_.make_next_touch(active_), boost::asio::detached);
  io.restart();
  io.poll();
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1", "touch 2"));
  EXPECT_EQ(active_.run.latest().fitted_touch_count, 0);
  arithmetic_.run();
  io.restart();
  io.run();
  EXPECT_EQ(active_.run.latest().fitted_touch_count, 1);
  EXPECT_EQ(active_.run.touches_done(), 2);
  expect_run_is_as_stored();
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
