#include "service/daemon/work_done.hpp"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <future>
#include <optional>

namespace cell {
namespace {

using namespace std::chrono_literals;

class WorkDoneTest : public ::testing::Test {
 protected:
  /// One of the threads does not end until the end is given up.
  void expect_given_up(boost::asio::thread_pool& blocked) {
    std::promise<void> given_up;
    boost::asio::post(blocked, [over = given_up.get_future().share()] { over.wait(); });
    const std::chrono::milliseconds patience = 1ms;
    WorkDone({&disk_, &arithmetic_}, watch_.emplace(), patience,
             [&] { return [&](const std::string&) { given_up.set_value(); }; });
    watch_.reset();
  }

  boost::asio::thread_pool arithmetic_{1};
  boost::asio::thread_pool disk_{1};
  std::optional<EndWatch> watch_;
};

TEST_F(WorkDoneTest, WaitsForBothThreads) {
  int computed = 0;
  int written = 0;
  boost::asio::post(arithmetic_, [&] { ++computed; });
  boost::asio::post(disk_, [&] { ++written; });
  const std::chrono::milliseconds patience = 1h;
  WorkDone({&disk_, &arithmetic_}, watch_.emplace(), patience, [] { return EndWatch::GiveUp(); });
  EXPECT_EQ(computed, 1);
  EXPECT_EQ(written, 1);
}

TEST_F(WorkDoneTest, ADiskThatDoesNotAnswerIsGivenUp) { expect_given_up(disk_); }

TEST_F(WorkDoneTest, AComputationThatDoesNotEndIsGivenUp) { expect_given_up(arithmetic_); }

}  // namespace
}  // namespace cell
