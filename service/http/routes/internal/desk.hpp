#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/thread_pool.hpp>
#include <optional>
#include <stop_token>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/routes/api.hpp"
#include "service/http/routes/reads.hpp"

namespace cell {

/// A thread that answers requests one after the other, and what it reads.
struct Api::Desk {
  Desk(boost::asio::any_io_executor given, const CellOperation& operation, int to_have_waiting,
       const char* to_say)
      : waiting_max(to_have_waiting), when_full(to_say), reads(operation, operation.store().file()) {
    if (!given) given = thread.emplace(1).get_executor();
    executor = std::move(given);
    reads.end_with(ending.get_token());
  }
  ~Desk() { end(); }
  void end() {
    if (!thread) return;
    ending.request_stop();
    thread->stop();  // nobody waits for an answer any more
    thread->join();
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  int waiting = 0;  // of the thread that serves, as the next two
  int waiting_max;
  const char* when_full;
  std::stop_source ending;
  Reads reads;                                     // of its own thread
  std::optional<boost::asio::thread_pool> thread;  // none where it was handed in
  boost::asio::any_io_executor executor;
};

}  // namespace cell
