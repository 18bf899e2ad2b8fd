#pragma once

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <exception>
#include <optional>
#include <utility>

#include "service/acquisition/active_run.hpp"
#include "service/acquisition/controller_session.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/touch_preparation.hpp"
#include "service/documents/plan.hpp"
#include "service/run/planning_problem.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/made_up_time.hpp"
#include "tests/service/acquisition/scripted_controller.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {

/// The paper's cell with a recipe that is planned in no time: few touches, few postures looked at.
inline const Cell& cell_of_owners() {
  static const Cell cell = [] {
    Cell made = edf();
    Recipe recipe = made.recipes.at("edf-25");
    recipe.name = "few";
    recipe.fit_per_face = 7;
    recipe.held_out_per_face = 1;
    recipe.reference_every = 0;
    recipe.candidate_count = 2'000;
    made.recipes.emplace(recipe.name, recipe);
    return made;
  }();
  return cell;
}

/// That recipe's plan, made once.
inline const Plan& plan_of_owners() {
  static const Plan plan = [] {
    const TipRegions regions(cell_of_owners());
    return std::get<Plan>(make_plan(regions, cell_of_owners().recipes.at("few")));
  }();
  return plan;
}

/// What the owners of an operation stand on: a made-up clock, a scripted controller, the status, a store in a
/// folder of its own. `faults` is what would go to the fault log.
class OwnersBench {
 public:
  OwnersBench() {
    spdlog::set_level(spdlog::level::off);
    controller.state->joints = to_wire(cell_of_owners().park_joints);
    wake.on_wait = [this] { tell_state(); };  // as the real one does, every 20 ms
  }

  /// The coroutine's result, once it is through: nothing here waits for anything but the made-up clock.
  template <class Result>
  Result run(boost::asio::awaitable<Result> work) {
    std::optional<Result> result;
    std::exception_ptr failure;
    boost::asio::co_spawn(io, std::move(work), [&](const std::exception_ptr& thrown, Result made) {
      failure = thrown;
      result = std::move(made);
    });
    io.restart();
    io.run();
    if (failure) std::rethrow_exception(failure);
    return *std::move(result);
  }
  void run(boost::asio::awaitable<void> work) {
    std::exception_ptr failure;
    boost::asio::co_spawn(io, std::move(work), [&](const std::exception_ptr& thrown) { failure = thrown; });
    io.restart();
    io.run();
    if (failure) std::rethrow_exception(failure);
  }

  /// The controller's newest state, as it reaches the session.
  void tell_state() {
    if (controller.is_connected) session.on_controller_state(controller.state.value());
  }

  /// A run of the recipe "few" that is begun in the store.
  ActiveRun begun_run(const std::string& recipe = "few") {
    const std::int64_t id = store.begin_run({.recipe = recipe, .started_at = "start"});
    return {.run = Run(id, regions, cell_of_owners().recipes.at(recipe), "start"),
            .conditions = "{}",
            .interruption = std::nullopt,
            .place_check = std::nullopt};
  }
  /// ... that has its plan.
  ActiveRun planned_run() {
    ActiveRun active = begun_run();
    active.run.set_plan(plan_of_owners().touches);
    preparation.begin(planning_problem(cell_of_owners(), active.run.recipe()));
    return active;
  }
  /// The contact of an arm without errors: where the touch that was sent last is planned.
  [[nodiscard]] cs8::TouchResult contact() const {
    cs8::TouchResult result;
    result.outcome = cs8::Outcome::kContact;
    result.source = cs8::CaptureSource::kLatched;
    result.contact = to_wire(preparation.made()->touch.joints);
    result.first_source = result.source;
    result.first_contact = result.contact;
    result.monitor_speed_percent = 100;
    result.edges = 1;
    return result;
  }

  boost::asio::io_context io{1};
  MadeUpTime time;
  MadeUpWake wake{time};
  std::vector<std::string> faults;
  std::vector<State> entered;
  ScriptedController controller;
  PublishedStatus status{
      time.clocks(),
      wake,
      "instance",
      {.describe = [](Status&) {},
       .on_entered = [this](State state) { entered.push_back(state); },
       .store_fault = [this](const std::string& name, const std::string&) { faults.push_back(name); }}};
  ControllerSession session{cell_of_owners(), controller, status, wake, time.clocks()};
  Folder folder;
  RunStore store{folder.path() / "touchcal.sqlite"};
  TipRegions regions{cell_of_owners()};
  TouchPreparation preparation;
};

}  // namespace cell
