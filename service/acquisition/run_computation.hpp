#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <concepts>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "service/acquisition/active_run.hpp"
#include "service/acquisition/late_warning.hpp"
#include "service/acquisition/touch_preparation.hpp"
#include "service/base/run_on.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// The arithmetic of a run, on a thread of its own: a millisecond for a result or a way, some tenths of a
/// second for the documents at the end, in which the operation's thread keeps the link and takes a stop. It
/// works on copies; what a copy gave counts in the run unless that has changed meanwhile
/// (Run::take_latest()). The run waits for it without a bound, but not without a word: see kUntoldMax.
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
  /// What `work(preparation, run)` returns for copies of both. What it has changed in the preparation and in
  /// the order of the run's plan counts then: whoever waits here is the only one who changes them. A stop or
  /// a lost link may have come meanwhile.
  template <std::invocable<TouchPreparation&, Run&> Work>
  boost::asio::awaitable<std::invoke_result_t<Work, TouchPreparation&, Run&>> prepared(
      TouchPreparation& preparation, Run& run, Work work) {
    using Result = std::invoke_result_t<Work, TouchPreparation&, Run&>;
    struct Prepared {
      TouchPreparation preparation;
      std::vector<PlanChange> changes;
      Result result;
    };
    const auto compute = [work = std::move(work), copy = preparation, of_run = run]() mutable {
      Result result = work(copy, of_run);
      return Prepared{std::move(copy), of_run.plan_changes(), std::move(result)};
    };
    auto computed = late_.told_when_late("the way to the next touch", run_on(executor_, compute));
    Prepared made = co_await std::move(computed);
    preparation = std::move(made.preparation);
    for (std::size_t i = run.plan_changes().size(); i < made.changes.size(); ++i)
      run.change_plan(made.changes[i]);
    co_return std::move(made.result);
  }
  /// verification_of() these.
  boost::asio::awaitable<VerificationOutcome> verification(RunKind kind, PastCalibration past, Cell cell,
                                                           Eigen::Isometry3d cell_from_block,
                                                           std::string tool);
  /// What the run is worth, see conclude(); without an outcome only its documents.
  boost::asio::awaitable<Conclusion> conclude(ActiveRun active, std::optional<RunOutcome> outcome);

 private:
  boost::asio::any_io_executor executor_;
  const TipRegions& regions_;
  LateWarning late_;
};

}  // namespace cell
