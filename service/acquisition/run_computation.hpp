#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <memory>
#include <optional>

#include "service/acquisition/active_run.hpp"
#include "service/acquisition/late_warning.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// The arithmetic of a run, on a thread of its own: a millisecond for a result, some tenths of a second for
/// the documents at the end, in which the operation's thread keeps the link and takes a stop. It works on
/// copies; what a copy gave counts in the run unless that has changed meanwhile (Run::take_latest()). The run
/// waits for it without a bound, but not without a word: see kUntoldMax.
class RunComputation {
 public:
  /// After so long the status warns of a computation (FaultCode::kComputationSlow) until its result is there.
  static constexpr std::chrono::seconds kUntoldMax{30};

  /// `regions`, those of the operation, and their cell must outlive it. A test gives its one executor.
  /// `status` and `alarm` are of the caller's thread.
  RunComputation(boost::asio::any_io_executor executor, const TipRegions& regions, PublishedStatus& status,
                 std::unique_ptr<Alarm> alarm)
      : executor_(std::move(executor)),
        regions_(regions),
        late_(FaultCode::kComputationSlow, kUntoldMax, status, std::move(alarm)) {}

  /// The same run with the result of all its touches.
  boost::asio::awaitable<Run> identified(Run run);
  /// What the run is worth, see conclude(); without an outcome only its documents.
  boost::asio::awaitable<Conclusion> conclude(ActiveRun active, std::optional<RunOutcome> outcome);

 private:
  boost::asio::any_io_executor executor_;
  const TipRegions& regions_;
  LateWarning late_;
};

}  // namespace cell
