#pragma once

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <utility>
#include <vector>

#include "service/daemon/end_watch.hpp"

namespace cell {

/// At its end all that was to be computed and written is done: it refers to coroutines that are destroyed
/// next. A disk may not answer, and a computation may take longer than who ends the daemon waits: then the
/// end is given up, see EndWatch.
class WorkDone {
 public:
  /// All must outlive it. Of `threads` one is waited for after the other: the disk is first, so that nobody
  /// hears of what is computed any more. `patience` and `give_up` are looked at then.
  WorkDone(std::vector<boost::asio::thread_pool*> threads, EndWatch& watch,
           const std::chrono::milliseconds& patience, std::function<EndWatch::GiveUp()> give_up)
      : threads_(std::move(threads)), watch_(watch), patience_(patience), give_up_(std::move(give_up)) {}
  ~WorkDone();
  WorkDone(const WorkDone&) = delete;
  WorkDone& operator=(const WorkDone&) = delete;

 private:
  std::vector<boost::asio::thread_pool*> threads_;
  EndWatch& watch_;
  const std::chrono::milliseconds& patience_;
  std::function<EndWatch::GiveUp()> give_up_;
};

}  // namespace cell
