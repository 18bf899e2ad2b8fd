// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/run_computation.hpp"

#include "service/base/run_on.hpp"

namespace cell {

namespace asio = boost::asio;

asio::awaitable<Run> RunComputation::identified(Run run) {
  const auto identify = [copy = std::move(run)]() mutable {
    copy.identify();
    return std::move(copy);
  };
  Run done = co_await run_on(executor_, identify);
  co_return done;
}

asio::awaitable<Conclusion> RunComputation::conclude(ActiveRun active, std::optional<RunOutcome> outcome) {
  const auto compute = [copy = std::move(active), outcome, cell = cell_]() mutable {
    const TipRegions regions(cell);  // those of the operation are for its thread
    const Verdict verdict = outcome ? cell::conclude(copy, *outcome, regions) : Verdict::kIncomplete;
    return Conclusion{verdict, copy.finished, result_json(copy, regions), arm_json(copy, cell)};
  };
  Conclusion concluded = co_await run_on(executor_, compute);
  co_return concluded;
}

}  // namespace cell
