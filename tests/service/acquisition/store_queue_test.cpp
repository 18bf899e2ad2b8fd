#include "service/acquisition/store_queue.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>
#include <thread>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class StoreQueueTest : public ::testing::Test, public OwnersBench {
 protected:
  boost::asio::thread_pool disk_{1};
  StoreQueue queue_{store, disk_.get_executor()};
};

TEST_F(StoreQueueTest, WorksOnItsOwnThreadInTheOrderOfTheQuestions) {
  std::thread::id where;
  queue_.behind([&where](RunStore& there) {
    where = std::this_thread::get_id();
    there.begin_run({.recipe = "first", .started_at = "start"});
  });
  const auto ask = [](RunStore& there) { return there.runs(10).size(); };
  EXPECT_EQ(run(queue_.run(ask)), 1u) << "what was asked for before is done before";
  EXPECT_NE(where, std::this_thread::get_id());
}

TEST_F(StoreQueueTest, WhatNobodyWaitsForIsLeftOutWhenTheDiskStandsStill) {
  std::promise<void> disk_goes_on;
  std::shared_future<void> stalled = disk_goes_on.get_future().share();
  int done = 0;
  queue_.behind([stalled](RunStore&) { stalled.wait(); });
  int taken = 1;
  while (taken <= StoreQueue::kBehindMax && queue_.behind([&done](RunStore&) { ++done; })) ++taken;
  EXPECT_EQ(taken, StoreQueue::kBehindMax);
  disk_goes_on.set_value();
  const auto nothing = [](RunStore&) {};
  run(queue_.run(nothing));
  EXPECT_EQ(done, StoreQueue::kBehindMax - 1);
  EXPECT_TRUE(queue_.behind([](RunStore&) {})) << "there is room again";
}

TEST_F(StoreQueueTest, ADiskThatTakesLongIsToldUntilItHasAnswered) {
  boost::asio::io_context stalled{1};
  StoreQueue waiting{store, stalled.get_executor()};
  auto* const alarm = new MadeUpAlarm;
  waiting.tell_when_slow(status, std::unique_ptr<Alarm>(alarm));
  const auto let_run = [this] {
    io.restart();
    io.poll();
  };
  std::optional<std::string> failure = "not done";
  const auto take = [&failure](const std::exception_ptr&, std::optional<std::string> why) { failure = why; };
  boost::asio::co_spawn(io, waiting.write([](RunStore&) {}), take);
  let_run();
  EXPECT_EQ(alarm->set_for, StoreQueue::kUntoldMax);
  EXPECT_FALSE(status.latest().warning) << "it is not late yet";
  alarm->ring();
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kStoreSlow);
  stalled.run();
  let_run();
  EXPECT_EQ(failure, std::nullopt);
  EXPECT_FALSE(status.latest().warning);
  boost::asio::co_spawn(io, waiting.write([](RunStore&) {}), take);
  let_run();
  EXPECT_TRUE(alarm->is_set());
  stalled.restart();
  stalled.run();
  let_run();
  EXPECT_FALSE(alarm->is_set()) << "none is left behind a write in time";
}

TEST_F(StoreQueueTest, SaysHowMuchADiskThatStandsStillHasNotDone) {
  std::promise<void> disk_goes_on;
  std::shared_future<void> stalled = disk_goes_on.get_future().share();
  const auto waiting_count = queue_.waiting_count();
  EXPECT_EQ(*waiting_count, 0);
  queue_.behind([stalled](RunStore&) { stalled.wait(); });
  const auto begun = queue_.begin([](RunStore&) {});
  EXPECT_EQ(*waiting_count, 2);
  disk_goes_on.set_value();
  EXPECT_FALSE(run(queue_.finish(begun)));
  EXPECT_EQ(*waiting_count, 0);
}

TEST_F(StoreQueueTest, AFailureThatNobodyWaitsForEndsNothing) {
  queue_.behind([](RunStore&) { throw std::runtime_error("the disk is full"); });
  const auto fail = [](RunStore&) -> int { throw std::runtime_error("the disk is full"); };
  EXPECT_THROW(run(queue_.run(fail)), std::runtime_error);
}

TEST_F(StoreQueueTest, WhatIsBehindAWriteIsDoneOnTheSameWayUnlessTheWriteFailed) {
  std::string done;
  const auto begun = queue_.begin([&done](RunStore&) { done += "write "; });
  EXPECT_FALSE(run(queue_.finish(begun, [&done](RunStore&) { done += "behind"; })));
  EXPECT_EQ(done, "write behind");
  const auto failed = queue_.begin([](RunStore&) { throw std::runtime_error("the disk is full"); });
  done.clear();
  EXPECT_EQ(run(queue_.finish(failed, [&done](RunStore&) { done += "behind"; })), "the disk is full");
  EXPECT_EQ(done, "");
}

TEST_F(StoreQueueTest, AFailureBehindAWriteLeavesTheWriteAsItIs) {
  const auto begun = queue_.begin([](RunStore&) {});
  EXPECT_FALSE(run(queue_.finish(begun, [](RunStore&) { throw std::runtime_error("the disk is full"); })));
}

TEST_F(StoreQueueTest, AFaultThatCouldNotBeStoredIsStoredBehindTheNextWrite) {
  sqlite3_commit_hook(
      store.database()->getHandle(), [](void*) { return 1; }, nullptr);
  queue_.append_fault({.at = "t", .code = "link_lost", .message = "nothing was heard"});
  const auto mend = [](RunStore& there) {
    sqlite3_commit_hook(there.database()->getHandle(), nullptr, nullptr);
    there.begin_run({.recipe = "next", .started_at = "start"});
  };
  EXPECT_FALSE(run(queue_.write(mend)));
  const auto count = [](RunStore& there) { return FaultLog(there.database()).page(10).size(); };
  EXPECT_EQ(run(queue_.run(count)), 1u);
}

}  // namespace
}  // namespace cell
