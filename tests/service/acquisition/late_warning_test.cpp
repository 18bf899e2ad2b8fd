#include "service/acquisition/late_warning.hpp"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <stdexcept>

#include "service/base/run_on.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

/// What is waited for is done when the test runs `elsewhere_`.
class LateWarningTest : public ::testing::Test, public OwnersBench {
 protected:
  void wait_for(const std::string& what, const std::function<int()>& work) {
    boost::asio::co_spawn(
        io, late_.told_when_late(what, run_on(elsewhere_.get_executor(), work)),
        [this](const std::exception_ptr& failure, int result) { ended_.push_back(failure ? -1 : result); });
    let_run();
  }
  void let_run() {
    io.restart();
    io.poll();
  }
  void do_one_elsewhere() {
    elsewhere_.restart();
    elsewhere_.run_one();
    let_run();
  }

  boost::asio::io_context elsewhere_{1};
  MadeUpAlarm* const alarm_ = new MadeUpAlarm;  // the warning's
  LateWarning late_{FaultCode::kStoreSlow, std::chrono::seconds(7), status, std::unique_ptr<Alarm>(alarm_)};
  std::vector<int> ended_;
};

TEST_F(LateWarningTest, IsNotGivenWhereSomethingIsDoneNowAndThen) {
  wait_for("one", [] { return 1; });
  wait_for("another", [] { return 2; });
  alarm_->set_for = std::chrono::seconds(0);
  do_one_elsewhere();
  EXPECT_EQ(alarm_->set_for, std::chrono::seconds(7)) << "it begins anew";
  alarm_->ring();
  EXPECT_TRUE(status.latest().warning);
  do_one_elsewhere();
  EXPECT_FALSE(status.latest().warning);
}

TEST_F(LateWarningTest, OfTwoWaitsTheFirstIsToldUntilBothAreOver) {
  wait_for("one", [] { return 1; });
  wait_for("another", [] { return 2; });
  alarm_->ring();
  EXPECT_TRUE(status.latest().warning.value().message().ends_with("one, for 7 s now"));
  do_one_elsewhere();
  EXPECT_EQ(ended_, std::vector({1}));
  EXPECT_TRUE(status.latest().warning);
  do_one_elsewhere();
  EXPECT_EQ(ended_, std::vector({1, 2}));
  EXPECT_FALSE(status.latest().warning);
}

TEST_F(LateWarningTest, AFailureEndsItToo) {
  wait_for("one", []() -> int { throw std::runtime_error("it failed"); });
  alarm_->ring();
  do_one_elsewhere();
  EXPECT_EQ(ended_, std::vector({-1}));
  EXPECT_FALSE(status.latest().warning);
  wait_for("the next", [] { return 3; });
  EXPECT_TRUE(alarm_->is_set());
  do_one_elsewhere();
  EXPECT_FALSE(alarm_->is_set());
}

}  // namespace
}  // namespace cell
