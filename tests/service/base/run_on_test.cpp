#include "service/base/run_on.hpp"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>
#include <stdexcept>
#include <thread>

namespace {

namespace asio = boost::asio;

struct Visited {
  std::thread::id caller_before, there, caller_after;
  int value = 0;
};

asio::awaitable<Visited> visit(asio::any_io_executor there) {
  Visited visited{.caller_before = std::this_thread::get_id(), .there = {}, .caller_after = {}};
  visited.value = co_await cell::run_on(there, [&visited] {
    visited.there = std::this_thread::get_id();
    return 42;
  });
  visited.caller_after = std::this_thread::get_id();
  co_return visited;
}

TEST(RunOn, WorksThereAndGoesOnAtTheCaller) {
  asio::io_context here;
  asio::thread_pool there(1);
  std::future<Visited> outcome;
  asio::co_spawn(here, visit(there.get_executor()),
                 [&outcome](const std::exception_ptr& failure, const Visited& visited) {
                   std::promise<Visited> promise;
                   failure ? promise.set_exception(failure) : promise.set_value(visited);
                   outcome = promise.get_future();
                 });
  auto work = asio::make_work_guard(here);
  while (!outcome.valid()) here.run_one();
  const Visited visited = outcome.get();
  EXPECT_EQ(visited.value, 42);
  EXPECT_EQ(visited.caller_before, std::this_thread::get_id());
  EXPECT_EQ(visited.caller_after, std::this_thread::get_id());
  EXPECT_NE(visited.there, std::this_thread::get_id());
}

TEST(RunOn, TakesAFailureBackToTheCaller) {
  asio::io_context here;
  std::string told;
  const auto fail = [&]() -> asio::awaitable<void> {
    try {
      co_await cell::run_on(here.get_executor(), [] { throw std::runtime_error("the disk is full"); });
    } catch (const std::runtime_error& error) {
      told = error.what();
    }
  };
  asio::co_spawn(here, fail(), [](const std::exception_ptr& failure) { EXPECT_FALSE(failure); });
  here.run();
  EXPECT_EQ(told, "the disk is full");
}

TEST(RunOn, ComesBehindWhatWasPostedBefore) {
  asio::io_context context;
  std::string order;
  const auto last = [&]() -> asio::awaitable<void> {
    co_await cell::run_on(context.get_executor(), [&] { order += 'b'; });
  };
  asio::co_spawn(context, last(), [](const std::exception_ptr&) {});
  asio::post(context, [&] { order += 'a'; });
  context.run();
  EXPECT_EQ(order, "ab");
}

}  // namespace
