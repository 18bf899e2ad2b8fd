#pragma once

#include <boost/asio/detail/concurrency_hint.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <functional>
#include <memory>
#include <optional>

#include "service/acquisition/cell_operation.hpp"
#include "service/base/context.hpp"
#include "service/http/routes/api.hpp"
#include "service/http/server/listener.hpp"
#include "service/store/run_store.hpp"
#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

inline constexpr std::uint16_t kControllerPort = 11'000;
inline constexpr std::uint16_t kHttpPort = 8080;
inline constexpr const char* kOperateToken = "operate";
inline constexpr const char* kStoreFile = "touchcal.sqlite";

/// Of one thread, and it always has something to wait for.
class Context : public cell::Context {
 public:
  Context() : cell::Context(BOOST_ASIO_CONCURRENCY_HINT_UNSAFE) {}
  /// Until its next timer; nothing when it has none. Zero when there was something to do, which was done.
  std::optional<Time> until_next_timer();

 private:
  boost::asio::executor_work_guard<executor_type> work_{get_executor()};
};

/// The daemon's side of a world: the operation with its link to the controller, the store, the arithmetic,
/// the HTTP port with all that is behind it. Its threads are contexts that take turns on one. To destroy it
/// is to kill the process: nothing is told, stored or stopped.
class SimulatedDaemon {
 public:
  /// Opens the store, as a process does that begins; std::exception when that fails. `regions` is of `cell`,
  /// and both must outlive it: what they have computed is not computed again at each start.
  SimulatedDaemon(const cell::TipRegions& regions, std::shared_ptr<const cell::Plan> plan);
  ~SimulatedDaemon();
  SimulatedDaemon(const SimulatedDaemon&) = delete;
  SimulatedDaemon& operator=(const SimulatedDaemon&) = delete;

  /// Begins. Nothing was done before.
  void launch();
  /// Sets who hears of each change of the status beside the HTTP port.
  void on_change(std::function<void(const cell::Status&)> listener);
  /// Does one thing of each thread; false when none has anything to do. `store_goes_on`: its disk answers.
  bool take_turn(bool store_goes_on);
  std::optional<Time> until_next_timer();

  /// SIGTERM.
  void begin_end();
  [[nodiscard]] bool has_ended() const { return has_ended_; }

  [[nodiscard]] cell::CellOperation& operation() { return *operation_; }
  [[nodiscard]] const cell::RunStore& store() const { return store_; }
  Context& context() { return operation_context_; }

 private:
  Context operation_context_, http_context_, store_context_, computation_context_, reader_context_,
      worker_context_;
  cell::RunStore store_;
  std::optional<cell::CellOperation> operation_;
  std::optional<cell::Api> api_;
  std::optional<cell::HttpListener> listener_;
  bool has_ended_ = false;
};

}  // namespace simulation
