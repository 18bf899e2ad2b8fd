#include "tests/simulation/simulated_daemon.hpp"

#include <boost/asio/co_spawn.hpp>
#include <exception>

#include "tests/simulation/waiting_turn.hpp"

namespace simulation {

std::optional<Time> Context::until_next_timer() {
  WaitingTurn turn([this] { stop(); });
  const bool did_something = run_one() > 0;
  restart();
  return did_something ? std::optional(Time{0}) : turn.until_next_timer();
}

SimulatedDaemon::SimulatedDaemon(const cell::TipRegions& regions, std::shared_ptr<const cell::Plan> plan)
    : store_(kStoreFile) {
  operation_.emplace(
      cell::CellOperation::Threads{operation_context_.get_executor(), computation_context_.get_executor()},
      regions.cell(), cell::StoreQueue(store_, store_context_.get_executor()),
      cell::Endpoint{"127.0.0.1", kControllerPort}, "simulated",
      cell::Clocks{std::chrono::system_clock::now, std::chrono::steady_clock::now});
  operation_->hand_in_plan(std::move(plan));
  operation_->hand_in_regions(regions.shared());
}

/// What waits in the other two contexts unwinds in that of the operation, so that comes last.
SimulatedDaemon::~SimulatedDaemon() {
  store_context_.give_up();
  computation_context_.give_up();
  operation_context_.give_up();
  operation_.reset();
}

bool SimulatedDaemon::take_turn(bool store_goes_on) {
  bool did_something = operation_context_.poll_one() > 0;
  if (store_goes_on) did_something = store_context_.poll_one() > 0 || did_something;
  return computation_context_.poll_one() > 0 || did_something;
}

void SimulatedDaemon::begin_end() {
  boost::asio::co_spawn(operation_context_, operation_->shut_down(),
                        [this](const std::exception_ptr& failure) {
                          if (failure) std::rethrow_exception(failure);
                          has_ended_ = true;
                        });
}

}  // namespace simulation
