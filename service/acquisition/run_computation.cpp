// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/run_computation.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

namespace cell {

namespace asio = boost::asio;

asio::awaitable<Run> RunComputation::identified(Run run) {
  std::string what = fmt::format("the result up to touch {}", run.touches_done());
  const auto identify = [copy = std::move(run)]() mutable {
    copy.identify();
    return std::move(copy);
  };
  auto computed = late_.told_when_late(std::move(what), run_on(executor_, identify));
  Run done = co_await std::move(computed);
  co_return done;
}

asio::awaitable<VerificationOutcome> RunComputation::verification(RunKind kind, PastCalibration past,
                                                                  Cell cell,
                                                                  Eigen::Isometry3d cell_from_block,
                                                                  std::string tool) {
  std::string what = fmt::format("the calibration of run {} once more", past.run.id);
  const auto compute = [kind, past = std::move(past), cell = std::move(cell), cell_from_block,
                        tool = std::move(tool)] {
    return verification_of(kind, past, cell, cell_from_block, tool);
  };
  auto computed = late_.told_when_late(std::move(what), run_on(executor_, compute));
  VerificationOutcome outcome = co_await std::move(computed);
  co_return outcome;
}

asio::awaitable<Conclusion> RunComputation::conclude(ActiveRun active, std::optional<RunOutcome> outcome) {
  std::string what = fmt::format("the documents at the end of run {}", active.run.id());
  // The cell is a copy: that of the operation may be another one as soon as its block is found elsewhere.
  const auto compute = [copy = std::move(active), outcome, cell = regions_.cell(), made = regions_.shared()] {
    return cell::conclude(copy, outcome, TipRegions(cell, made));
  };
  auto computed = late_.told_when_late(std::move(what), run_on(executor_, compute));
  Conclusion concluded = co_await std::move(computed);
  co_return concluded;
}

}  // namespace cell
