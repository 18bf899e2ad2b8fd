#pragma once

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "service/acquisition/alarm.hpp"
#include "service/acquisition/published_status.hpp"

namespace cell {

/// What the run waits for without a bound, but not without a word: when a wait has lasted some time, the
/// status warns of it until it is over. One thread.
class LateWarning {
 public:
  /// `status` must outlive it.
  LateWarning(FaultCode code, std::chrono::seconds untold_max, PublishedStatus& status,
              std::unique_ptr<Alarm> alarm)
      : code_(code), untold_max_(untold_max), status_(status), alarm_(std::move(alarm)) {}

  /// Returns what `work` returned or threw; `what` says in words what is waited for. Of several waits at a
  /// time none is told as long as one of them ends now and then; what is told, the first, is told until all
  /// are over. Where the wait is given up with its context, the alarm goes with
  /// this owner: nothing is published then.
  template <class Result>
  boost::asio::awaitable<Result> told_when_late(std::string what, boost::asio::awaitable<Result> work) {
    begin(std::move(what));
    std::exception_ptr failure;
    if constexpr (std::is_void_v<Result>) {
      try {
        co_await std::move(work);
      } catch (...) {
        failure = std::current_exception();
      }
      end();
      if (failure) std::rethrow_exception(failure);
    } else {
      std::optional<Result> result;
      try {
        Result made = co_await std::move(work);
        result.emplace(std::move(made));
      } catch (...) {
        failure = std::current_exception();
      }
      end();
      if (failure) std::rethrow_exception(failure);
      co_return *std::move(result);
    }
  }

 private:
  void begin(std::string what);
  void set_alarm();
  void end();

  FaultCode code_;
  std::chrono::seconds untold_max_;
  PublishedStatus& status_;
  std::unique_ptr<Alarm> alarm_;
  std::string what_;  // the first of those that wait
  int waits_ = 0;
  bool is_told_ = false;
};

}  // namespace cell
