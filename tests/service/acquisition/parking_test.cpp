#include "service/acquisition/parking.hpp"

#include <gmock/gmock.h>

#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using ParkingTest = ExecutorBench;

TEST_F(ParkingTest, AnArmThatIsThereDoesNotMove) {
  EXPECT_TRUE(run(parking.park(active_)));
  EXPECT_THAT(controller.asked, IsEmpty());
}

TEST_F(ParkingTest, GoesThereFromATouch) {
  run(touches_.make_next_touch(active_));
  controller.asked.clear();
  EXPECT_TRUE(run(parking.park(active_)));
  EXPECT_THAT(controller.asked, ElementsAre(HasSubstr("travel"), HasSubstr("acknowledge")));
}

TEST_F(ParkingTest, ByHandThePersonDoes) {
  run(touches_.make_next_touch(active_));
  controller.asked.clear();
  active_.guided = true;
  EXPECT_TRUE(run(parking.park(active_)));
  EXPECT_THAT(controller.asked, IsEmpty());
}

TEST_F(ParkingTest, ALostLinkIsNoArrival) {
  run(touches_.make_next_touch(active_));
  controller.on_move = [] { return ScriptedController::lost(); };
  EXPECT_FALSE(run(parking.park(active_)));
}

}  // namespace
}  // namespace cell
