#include "tests/simulation/simulated_daemon.hpp"

#include <algorithm>
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
  operation_.emplace(cell::CellOperation::Threads{.operation = operation_context_.get_executor(),
                                                  .computation = computation_context_.get_executor(),
                                                  .planning = computation_context_.get_executor()},
                     regions.cell(), cell::StoreQueue(store_, store_context_.get_executor()),
                     cell::Endpoint{"127.0.0.1", kControllerPort}, "simulated",
                     cell::Clocks{std::chrono::system_clock::now, std::chrono::steady_clock::now});
  operation_->hand_in_plan(std::move(plan));
  operation_->hand_in_regions(regions.shared());
  api_.emplace(http_context_.get_executor(),
               cell::ApiThreads{.operation = operation_context_.get_executor(),
                                .store = store_context_.get_executor(),
                                .reader = reader_context_.get_executor(),
                                .worker = worker_context_.get_executor()},
               *operation_, cell::Tokens{.operate = kOperateToken, .view = "view"});
  listener_.emplace(http_context_.get_executor(),
                    boost::asio::ip::tcp::endpoint(boost::asio::ip::address_v4::loopback(), kHttpPort),
                    *api_);
}

/// What waits elsewhere unwinds in the context of the operation, and that in the one of the sockets.
SimulatedDaemon::~SimulatedDaemon() {
  for (Context* one : {&store_context_, &computation_context_, &reader_context_, &worker_context_,
                       &operation_context_, &http_context_})
    one->give_up();
  listener_.reset();
  api_.reset();
  operation_.reset();
}

void SimulatedDaemon::launch() {
  operation_->launch();
  listener_->launch();
}

void SimulatedDaemon::on_change(std::function<void(const cell::Status&)> listener) {
  operation_->on_change([this, listener = std::move(listener)](const cell::Status& status) {
    listener(status);
    api_->services().feed.publish(status);
  });
}

std::optional<Time> SimulatedDaemon::until_next_timer() {
  const auto of_operation = operation_context_.until_next_timer();
  const auto of_http = http_context_.until_next_timer();
  if (!of_operation || !of_http) return of_operation ? of_operation : of_http;
  return std::min(*of_operation, *of_http);
}

bool SimulatedDaemon::take_turn(bool store_goes_on) {
  bool did_something = operation_context_.poll_one() > 0;
  for (Context* one : {&http_context_, &reader_context_, &worker_context_})
    did_something = one->poll_one() > 0 || did_something;
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
