#include "service/acquisition/store_queue.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <exception>

namespace cell {

namespace {

std::optional<std::string> failure_of(const std::function<void(RunStore&)>& work, RunStore& store) {
  try {
    work(store);
    return std::nullopt;
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

std::shared_ptr<void> StoreQueue::count_one() const {
  ++*waiting_count_;
  return {nullptr, [count = waiting_count_](void*) { --*count; }};
}

boost::asio::awaitable<std::optional<std::string>> StoreQueue::write(std::function<void(RunStore&)> work) {
  const auto try_it = [work = std::move(work), faults = faults_](RunStore& store) {
    auto failure = failure_of(work, store);
    if (!failure) faults->store_waiting();
    return failure;
  };
  co_return co_await run(try_it);
}

StoreQueue::Begun StoreQueue::begin(std::function<void(RunStore&)> work) {
  Begun begun;
  boost::asio::post(executor_, [&store = store_, waits = count_one(), failure = begun.failure_,
                                work = std::move(work)] { *failure = failure_of(work, store); });
  return begun;
}

boost::asio::awaitable<std::optional<std::string>> StoreQueue::finish(Begun begun,
                                                                      std::function<void(RunStore&)> behind) {
  const auto go_on = [failure = begun.failure_, behind = std::move(behind),
                      faults = faults_](RunStore& store) -> std::optional<std::string> {
    if (*failure) return *failure;
    if (behind) {
      if (const auto left_out = failure_of(behind, store))
        spdlog::error("something could not be stored: {}", *left_out);
    }
    faults->store_waiting();
    return std::nullopt;
  };
  const auto failure = co_await run(go_on);
  co_return failure;
}

void StoreQueue::write_then(std::function<void(RunStore&)> work, boost::asio::any_io_executor caller,
                            std::function<void(std::optional<std::string>)> then) {
  boost::asio::post(executor_, [&store = store_, waits = count_one(), faults = faults_,
                                work = std::move(work), caller = std::move(caller), then = std::move(then)] {
    auto failure = failure_of(work, store);
    if (!failure) faults->store_waiting();
    boost::asio::post(caller, [then, failure = std::move(failure)] { then(failure); });
  });
}

void StoreQueue::append_fault(StoredFault fault) {
  behind([faults = faults_, fault = std::move(fault)](RunStore&) {
    faults->append(fault.run_id, fault.at, fault.code, fault.message);
  });
}

bool StoreQueue::behind(std::function<void(RunStore&)> work) {
  if (*behind_count_ >= kBehindMax) {
    spdlog::error("the disk does not answer: something is not stored");
    return false;
  }
  ++*behind_count_;
  boost::asio::post(executor_,
                    [&store = store_, waits = count_one(), count = behind_count_, work = std::move(work)] {
                      try {
                        work(store);
                      } catch (const std::exception& error) {
                        spdlog::error("something could not be stored: {}", error.what());
                      }
                      --*count;
                    });
  return true;
}

}  // namespace cell
