#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include "service/acquisition/cell_operation.hpp"
#include "service/store/run_store.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {

/// The paper's cell, or the given one, in operation without a controller, its store in a folder of its own.
/// Not launched: it stays in the state that the commands of a test lead to.
class QuietCell {
 public:
  /// `steady`: the clock of deadlines.
  explicit QuietCell(Cell cell = edf(), std::function<std::chrono::steady_clock::time_point()> steady =
                                            std::chrono::steady_clock::now)
      : shipped_(std::move(cell)), steady_(std::move(steady)) {}
  boost::asio::io_context& context() { return context_; }
  RunStore& store() { return store_; }
  CellOperation& operation() { return operation_; }
  /// Runs the coroutine to its end; returns its result.
  template <class Result>
  Result run(boost::asio::awaitable<Result> work) {
    std::optional<Result> result;
    std::exception_ptr failure;
    boost::asio::co_spawn(context_, std::move(work), [&](const std::exception_ptr& thrown, Result made) {
      failure = thrown;
      result = std::move(made);
    });
    context_.restart();
    while (!result) context_.run_one();
    if (failure) std::rethrow_exception(failure);
    return *std::move(result);
  }

 private:
  /// Where nobody listens: a port that is bound, so that nobody else can take it.
  Endpoint nobody() {
    const boost::asio::ip::tcp::endpoint any_port(boost::asio::ip::address_v4::loopback(), 0);
    held_port_.open(any_port.protocol());
    held_port_.bind(any_port);
    return {"127.0.0.1", held_port_.local_endpoint().port()};
  }

  Cell shipped_;
  std::function<std::chrono::steady_clock::time_point()> steady_;
  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
  boost::asio::io_context context_{1};
  boost::asio::ip::tcp::socket held_port_{context_};
  boost::asio::thread_pool planner_{1};
  CellOperation operation_{{context_.get_executor(), context_.get_executor(), planner_.get_executor()},
                           shipped_,
                           StoreQueue(store_, context_.get_executor()),
                           nobody(),
                           "instance",
                           Clocks{[] { return std::chrono::system_clock::time_point{}; }, steady_}};
};

}  // namespace cell
