#pragma once

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "service/acquisition/cell_operation.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {

/// The whole of an operation over a scripted controller: all it meets is said by the test.
class OperationBench {
 protected:
  /// With the arithmetic of a run on another context, which waits until a test lets it.
  explicit OperationBench(std::unique_ptr<boost::asio::io_context> arithmetic = nullptr,
                          const Cell& cell = cell_of_owners())
      : cell_(cell), arithmetic_(std::move(arithmetic)) {
    spdlog::set_level(spdlog::level::off);
  }
  ~OperationBench() {
    controller_->is_connected = false;  // nobody whose answer the end waits for
    shut_down();
    planner_.join();
  }
  OperationBench(const OperationBench&) = delete;
  OperationBench& operator=(const OperationBench&) = delete;

  void shut_down() {
    bool down = false;
    boost::asio::co_spawn(io_, operation_.shut_down(), [&](const std::exception_ptr&) { down = true; });
    io_.restart();
    while (!down) io_.run_one();
  }
  /// The controller tells its state; what waits looks at it.
  void tell_state() {
    controller_->hooks.on_state(controller_->state.value());
    io_.restart();
    io_.poll();
  }
  void launch() {
    operation_.launch();
    io_.poll();
    tell_state();
  }
  std::variant<Started, CommandRefusal> start(const StartRequest& request) {
    std::optional<std::variant<Started, CommandRefusal>> answer;
    boost::asio::co_spawn(io_, operation_.start(request),
                          [&](const std::exception_ptr&, const std::variant<Started, CommandRefusal>& given) {
                            answer = given;
                          });
    io_.restart();
    while (!answer) io_.run_one();
    return *answer;
  }
  /// The controller tells its state all the time.
  void run_until(const std::function<bool()>& condition) {
    while (!condition()) {
      time_.pass(std::chrono::milliseconds(10));
      if (controller_->is_connected) controller_->hooks.on_state(*controller_->state);
      io_.restart();
      io_.run_one();
    }
    io_.poll();
  }

  const Cell cell_;
  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite",
                  {.sleep = [this](std::chrono::milliseconds waited) { time_.pass(waited); }}};
  boost::asio::io_context io_{1};
  std::unique_ptr<boost::asio::io_context> arithmetic_;
  boost::asio::thread_pool planner_{1};
  MadeUpTime time_;
  ScriptedController* controller_ = new ScriptedController;  // the operation's
  CellOperation operation_{{.operation = io_.get_executor(),
                            .computation = (arithmetic_ ? *arithmetic_ : io_).get_executor(),
                            .planning = planner_.get_executor()},
                           cell_,
                           StoreQueue(store_, io_.get_executor()),
                           std::unique_ptr<Controller>(controller_),
                           "instance",
                           time_.clocks()};
};

}  // namespace cell
