#include "service/acquisition/alarm.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>

namespace cell {
namespace {

using namespace std::chrono_literals;

class TimerAlarmTest : public ::testing::Test {
 protected:
  std::function<void()> count(int& calls) {
    return [&calls] { ++calls; };
  }

  boost::asio::io_context io_{1};
  TimerAlarm alarm_{io_.get_executor()};
  int first_ = 0;
  int second_ = 0;
};

TEST_F(TimerAlarmTest, CallsOnce) {
  alarm_.set(0ms, count(first_));
  EXPECT_EQ(first_, 0) << "on its executor only";
  io_.run();
  EXPECT_EQ(first_, 1);
}

TEST_F(TimerAlarmTest, IsCancelledAlsoWhereItsTimeHasPassed) {
  // Both times have passed; the call of the first cancels the second, whose own is queued by then.
  TimerAlarm other(io_.get_executor());
  alarm_.set(0ms, [&] {
    ++first_;
    other.cancel();
  });
  other.set(0ms, count(second_));
  io_.run();
  EXPECT_EQ(first_, 1);
  EXPECT_EQ(second_, 0);
}

TEST_F(TimerAlarmTest, OnlyTheLastOfTwoIsCalled) {
  alarm_.set(0ms, count(first_));
  alarm_.set(0ms, count(second_));
  io_.run();
  EXPECT_EQ(first_, 0);
  EXPECT_EQ(second_, 1);
}

TEST_F(TimerAlarmTest, ThatIsGoneCallsNobody) {
  { TimerAlarm(io_.get_executor()).set(0ms, count(first_)); }
  io_.run();
  EXPECT_EQ(first_, 0);
}

}  // namespace
}  // namespace cell
