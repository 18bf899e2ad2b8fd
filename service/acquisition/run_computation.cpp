// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/run_computation.hpp"

#include <spdlog/fmt/fmt.h>

#include <exception>
#include <utility>

#include "service/base/run_on.hpp"

namespace cell {

namespace asio = boost::asio;

/// Where the wait is given up with its context, the alarm goes with this owner: nothing is published then.
template <class Result>
asio::awaitable<Result> RunComputation::told_when_late(std::string what, asio::awaitable<Result> work) {
  alarm_->set(kUntoldMax, [this, what = std::move(what)] {
    status_.warn({FaultCode::kComputationSlow, fmt::format("{}, for {} s now", what, kUntoldMax.count())});
  });
  std::optional<Result> result;
  std::exception_ptr failure;
  try {
    Result made = co_await std::move(work);
    result.emplace(std::move(made));
  } catch (...) {
    failure = std::current_exception();
  }
  alarm_->cancel();
  status_.end_warning(FaultCode::kComputationSlow);
  if (failure) std::rethrow_exception(failure);
  co_return *std::move(result);
}

asio::awaitable<Run> RunComputation::identified(Run run) {
  std::string what = fmt::format("the result up to touch {}", run.touches_done());
  const auto identify = [copy = std::move(run)]() mutable {
    copy.identify();
    return std::move(copy);
  };
  auto computed = told_when_late(std::move(what), run_on(executor_, identify));
  Run done = co_await std::move(computed);
  co_return done;
}

asio::awaitable<Conclusion> RunComputation::conclude(ActiveRun active, std::optional<RunOutcome> outcome) {
  std::string what = fmt::format("the documents at the end of run {}", active.run.id());
  // The cell is a copy: that of the operation may be another one as soon as its block is found elsewhere.
  const auto compute = [copy = std::move(active), outcome, cell = regions_.cell(),
                        made = regions_.shared()]() mutable {
    const TipRegions regions(cell, made);
    const Verdict verdict = outcome ? cell::conclude(copy, *outcome, regions) : Verdict::kIncomplete;
    return Conclusion{verdict, copy.finished, result_json(copy, regions), arm_json(copy, cell)};
  };
  auto computed = told_when_late(std::move(what), run_on(executor_, compute));
  Conclusion concluded = co_await std::move(computed);
  co_return concluded;
}

}  // namespace cell
