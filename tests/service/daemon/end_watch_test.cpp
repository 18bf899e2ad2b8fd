#include "service/daemon/end_watch.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <future>

namespace cell {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class EndWatchTest : public ::testing::Test {
 protected:
  EndWatch::GiveUp give_up() {
    return [this](const std::string& why) { given_up_.set_value(why); };
  }
  std::string why_given_up() { return given_up_.get_future().get(); }

 private:
  std::promise<std::string> given_up_;
};

TEST_F(EndWatchTest, AnEndInTimeIsNotGivenUp) {
  EndWatch watch;
  watch.begin(1h, [](const std::string& why) { FAIL() << why; });
}

TEST_F(EndWatchTest, OneThatNeverBeganIsNone) { const EndWatch watch; }

TEST_F(EndWatchTest, AnEndThatLastsIsGivenUp) {
  EndWatch watch;
  watch.begin(1ms, give_up());
  EXPECT_THAT(why_given_up(), HasSubstr("not come within 1ms"));
}

TEST_F(EndWatchTest, ASignalShortensTheWait) {
  EndWatch watch;
  watch.begin(1h, give_up());
  ASSERT_EQ(std::raise(SIGTERM), 0);
  EXPECT_THAT(why_given_up(), HasSubstr("signal 15"));
}

}  // namespace
}  // namespace cell
