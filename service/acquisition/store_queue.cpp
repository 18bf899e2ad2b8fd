#include "service/acquisition/store_queue.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <exception>

namespace cell {

boost::asio::awaitable<std::optional<std::string>> StoreQueue::write(std::function<void(RunStore&)> work) {
  const auto try_it = [work = std::move(work),
                       faults = faults_](RunStore& store) -> std::optional<std::string> {
    try {
      work(store);
      faults->store_waiting();
      return std::nullopt;
    } catch (const std::exception& error) {
      return error.what();
    }
  };
  co_return co_await run(try_it);
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
  boost::asio::post(executor_, [&store = store_, count = behind_count_, work = std::move(work)] {
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
