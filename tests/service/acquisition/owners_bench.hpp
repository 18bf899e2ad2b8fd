#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "service/acquisition/active_run.hpp"
#include "service/acquisition/block_move.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/parking.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/run_computation.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/touch_preparation.hpp"
#include "service/documents/plan.hpp"
#include "tests/service/acquisition/made_up_time.hpp"
#include "tests/service/acquisition/scripted_controller.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {

/// The paper's cell with a recipe that is planned in no time: few touches, few postures looked at.
const Cell& cell_of_owners();

/// That recipe's plan, made once.
const Plan& plan_of_owners();

/// The contact of an arm without errors at these joints.
cs8::TouchResult contact_at(const calib::JointVector& joints);

/// What the owners of an operation stand on: a made-up clock, a scripted controller, the status, a store in a
/// folder of its own. `faults` is what would go to the fault log.
class OwnersBench {
 public:
  OwnersBench();
  ~OwnersBench();
  OwnersBench(const OwnersBench&) = delete;
  OwnersBench& operator=(const OwnersBench&) = delete;

  /// Runs the coroutine to its end: nothing here waits for anything but the made-up clock.
  void run(boost::asio::awaitable<void> work);
  /// The same; returns its result.
  template <class Result>
  Result run(boost::asio::awaitable<Result> work) {
    std::optional<Result> result;
    run(keep(std::move(work), result));
    return *std::move(result);
  }

  /// A person confirms the run; that it was asked for is not in `controller.asked`.
  void confirm(std::uint32_t run_number);
  /// The controller's newest state, as it reaches the session.
  void tell_state();

  /// A run of the recipe "few" that is begun in the store.
  ActiveRun begun_run(const std::string& recipe = "few");
  /// ... that has its plan.
  ActiveRun planned_run();
  /// The contact of an arm without errors: where the touch that was sent last is planned.
  [[nodiscard]] cs8::TouchResult contact() const;

  boost::asio::io_context io{1};
  MadeUpTime time;
  MadeUpWake wake{time};
  std::vector<std::string> faults;
  std::vector<State> entered;
  ScriptedController controller;
  PublishedStatus status;
  ControllerSession session;
  Folder folder;
  /// Called at each look of the store at another program's lock; the wait between takes made-up time.
  std::function<void()> on_lock_wait;
  RunStore store;
  StoreQueue queue{store, io.get_executor()};
  TipRegions regions;
  RunComputation computation{io.get_executor(), regions, status, std::make_unique<MadeUpAlarm>()};
  TouchPreparation preparation;
  Parking parking{cell_of_owners(), computation, preparation, session, status};
  BlockMove block_move{cell_of_owners(), parking, queue, status, wake};

 private:
  template <class Result>
  static boost::asio::awaitable<void> keep(boost::asio::awaitable<Result> work,
                                           std::optional<Result>& result) {
    Result made = co_await std::move(work);
    result = std::move(made);
  }
};

}  // namespace cell
