#pragma once

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>

#include "service/daemon/end_watch.hpp"

namespace cell {

/// At its end all that was to be computed and written is done: it refers to coroutines that are destroyed
/// next. A disk may not answer, and a computation may take longer than who ends the daemon waits: then the
/// end is given up, see EndWatch.
class WorkDone {
 public:
  /// All must outlive it. `patience` and `give_up` are looked at then.
  WorkDone(boost::asio::thread_pool& arithmetic, boost::asio::thread_pool& disk, EndWatch& watch,
           const std::chrono::milliseconds& patience, std::function<EndWatch::GiveUp()> give_up)
      : arithmetic_(arithmetic),
        disk_(disk),
        watch_(watch),
        patience_(patience),
        give_up_(std::move(give_up)) {}
  ~WorkDone();
  WorkDone(const WorkDone&) = delete;
  WorkDone& operator=(const WorkDone&) = delete;

 private:
  boost::asio::thread_pool& arithmetic_;
  boost::asio::thread_pool& disk_;
  EndWatch& watch_;
  const std::chrono::milliseconds& patience_;
  std::function<EndWatch::GiveUp()> give_up_;
};

}  // namespace cell
