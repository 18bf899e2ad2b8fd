#include "tests/service/acquisition/owners_bench.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <exception>

#include "cs8_protocol/wire_units.hpp"
#include "service/run/planning_problem.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

const Cell& cell_of_owners() {
  static const Cell cell = [] {
    Cell made = edf();
    Recipe recipe = made.recipes.at("edf-25");
    recipe.name = "few";
    recipe.fit_per_face = 7;
    recipe.held_out_per_face = 1;
    recipe.reference_every = 0;
    recipe.candidate_count = 2'000;
    made.recipes.emplace(recipe.name, recipe);
    BlockPlace aside{.name = "aside", .std = calib::PlaceDeviation{1e-5, 3e-5}};
    aside.first_from_place.translation() = Eigen::Vector3d(0.06, 0.0, 0.03);
    made.block.places.push_back(aside);
    recipe.name = "two places";
    recipe.places = {0};
    recipe.fit_per_face = 4;
    made.recipes.emplace(recipe.name, recipe);
    return made;
  }();
  return cell;
}

const Plan& plan_of_owners() {
  static const Plan plan = [] {
    const TipRegions regions(cell_of_owners());
    return std::get<Plan>(make_plan(regions, cell_of_owners().recipes.at("few")));
  }();
  return plan;
}

OwnersBench::OwnersBench()
    : status(
          time.clocks(), wake, "instance",
          {.describe = [](Status&) {},
           .on_entered = [this](State state) { entered.push_back(state); },
           .store_fault = [this](const std::string& name, const std::string&) { faults.push_back(name); }}),
      session(cell_of_owners(), controller, status, wake, time.clocks()),
      store(folder.path() / "touchcal.sqlite", {.sleep =
                                                    [this](std::chrono::milliseconds waited) {
                                                      time.pass(waited);
                                                      if (on_lock_wait) on_lock_wait();
                                                    }}),
      regions(cell_of_owners()) {
  spdlog::set_level(spdlog::level::off);
  controller.state->joints = to_wire(cell_of_owners().park_joints);
  wake.on_wait = [this] { tell_state(); };  // as the real one does, every 20 ms
}

OwnersBench::~OwnersBench() = default;

void OwnersBench::run(boost::asio::awaitable<void> work) {
  std::exception_ptr failure;
  boost::asio::co_spawn(io, std::move(work), [&](const std::exception_ptr& thrown) { failure = thrown; });
  io.restart();
  io.run();
  if (failure) std::rethrow_exception(failure);
}

void OwnersBench::confirm(std::uint32_t run_number) {
  controller.state->permit = cs8::PermitState::kGranted;
  if (!run(session.obtain_permit(run_number))) throw std::runtime_error("nobody confirms");
  controller.asked.clear();
}

void OwnersBench::tell_state() {
  if (controller.is_connected) session.on_controller_state(controller.state.value());
}

ActiveRun OwnersBench::begun_run(const std::string& recipe) {
  const std::int64_t id = store.begin_run({.recipe = recipe, .started_at = "start"});
  return {.run = Run(id, regions, cell_of_owners().recipes.at(recipe), "start"),
          .conditions = "{}",
          .interruption = std::nullopt,
          .place_check = std::nullopt};
}

ActiveRun OwnersBench::planned_run() {
  ActiveRun active = begun_run();
  active.run.set_plan(plan_of_owners().touches);
  preparation.begin(planning_problem(cell_of_owners(), active.run.recipe()));
  return active;
}

cs8::TouchResult OwnersBench::contact() const { return contact_at(preparation.made()->touch.joints); }

cs8::TouchResult contact_at(const calib::JointVector& joints) {
  cs8::TouchResult result;
  result.outcome = cs8::Outcome::kContact;
  result.source = cs8::CaptureSource::kLatched;
  result.contact = to_wire(joints);
  result.first_source = result.source;
  result.first_contact = result.contact;
  result.search_speed_um_s = cs8::um_s_from_metres_per_second(cell_of_owners().speeds.contact_m_s());
  result.monitor_speed_percent = 100;
  result.edges = 1;
  return result;
}

}  // namespace cell
