#include "tests/end_to_end/loopback_cell.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <chrono>
#include <stdexcept>

#include "config/fault_file.hpp"
#include "service/documents/json_view.hpp"
#include "sim_controller/fault_names.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

/// No test waits longer for a condition; with sanitizers on a loaded machine a run takes a minute and more.
constexpr std::chrono::seconds kPatience{300};

}  // namespace

LoopbackCell::LoopbackCell(const std::string& cell_name)
    : cell(shipped_cell(cell_name)), store_(folder_ / "touchcal.sqlite") {
  spdlog::set_level(spdlog::level::off);
  cell.deadlines.heartbeat_timeout = sim::kHeartbeatTimeoutMax;  // the machine may be busy with other tests
  cell::Recipe recipe = cell.recipes.at(kRecipe);
  recipe.name = kShortRecipe;
  recipe.fit_per_face = 7;
  recipe.held_out_per_face = 1;
  recipe.reference_every = 0;      // a fault with the n-th touch comes with the n-th of the plan
  recipe.candidate_count = 2'000;  // each test plans anew, and what it looks at is not the accuracy
  cell.recipes.emplace(recipe.name, recipe);
}

cell::Recipe& LoopbackCell::use(cell::Cell other, int candidate_count) {
  other.deadlines.heartbeat_timeout = cell.deadlines.heartbeat_timeout;
  cell = std::move(other);
  cell::Recipe recipe = cell.recipes.at("quick");
  recipe.name = kFewCandidates;
  recipe.candidate_count = candidate_count;
  return cell.recipes.insert_or_assign(kFewCandidates, std::move(recipe)).first->second;
}

void LoopbackCell::shut_down() {
  bool down = false;
  boost::asio::co_spawn(io_, operation_->shut_down(), [&down](const std::exception_ptr&) { down = true; });
  run_until([&](const cell::Status&) { return down && !operation_->is_planning(); });
}

void LoopbackCell::relaunch() {
  shut_down();
  io_.poll();  // what the client still had to do
  operation_.reset();
  launch();
}

LoopbackCell::~LoopbackCell() {
  if (!operation_) return;
  try {
    shut_down();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "the operation does not shut down: %s\n", error.what());
    std::abort();  // going on would free what its coroutine uses
  }
}

sim::Plant LoopbackCell::true_plant() const {
  return sim::make_plant(cell, shipped_truth(cell.file.parent_path().filename().string()));
}

void LoopbackCell::serve(std::vector<sim::PlannedFault> faults, double speed) {
  serve(true_plant(), {.controller = {.speed = speed}, .faults = std::move(faults)});
}

void LoopbackCell::serve(sim::Plant plant, sim::ServerOptions options) {
  server_.reset();
  server_ = std::make_unique<sim::Server>(io_, "127.0.0.1", port_, std::move(plant), std::move(options));
  port_ = server_->port();
}

void LoopbackCell::inject(const std::string& line) {
  server_->inject(sim::planned(std::get<cell::DeclaredFault>(cell::parse_control_line(line))));
}

void LoopbackCell::launch(std::optional<std::uint16_t> port) {
  operation_.emplace(
      cell::CellOperation::Threads{io_.get_executor(), computation_.get_executor(), planner_.get_executor()},
      cell, cell::StoreQueue(store_, io_.get_executor()), cell::Endpoint{"127.0.0.1", port.value_or(port_)},
      "end-to-end", cell::Clocks{std::chrono::system_clock::now, std::chrono::steady_clock::now});
  if (!place_file.empty()) operation_->keep_place_in(place_file);
  operation_->launch();
}

void LoopbackCell::run_until(const std::function<bool(const cell::Status&)>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!condition(operation_->status())) {
    if (std::chrono::steady_clock::now() >= deadline) {
      throw std::runtime_error("waited in vain: " + cell::status_document(operation_->status()));
    }
    io_.run_one_until(deadline);
  }
}

void LoopbackCell::run_until(cell::State state) {
  run_until([state](const cell::Status& status) { return status.state == state; });
}

void LoopbackCell::run_until_touches(int count) {
  run_until([count](const cell::Status& status) { return status.touches_done >= count; });
}

void LoopbackCell::run_until_over() {
  run_until([](const cell::Status& status) {
    return !cell::is_active(status.state) || (status.state == cell::State::kHeld && status.fault);
  });
}

std::int64_t LoopbackCell::start(const std::string& recipe) {
  const auto answer = ask_to_start(cell::StartRequest{.recipe = recipe});
  if (const auto* refusal = std::get_if<cell::CommandRefusal>(&answer)) {
    std::string why = refusal->detail;
    for (const cell::Unmet& unmet : refusal->unmet) why += "; " + unmet.code;
    throw std::runtime_error(why);
  }
  return std::get<cell::Started>(answer).run.id;
}

std::variant<cell::Started, cell::CommandRefusal> LoopbackCell::ask_to_start(
    const cell::StartRequest& request) {
  std::optional<std::variant<cell::Started, cell::CommandRefusal>> answer;
  boost::asio::co_spawn(io_, operation_->start(request),
                        [&answer](const std::exception_ptr& failure,
                                  const std::variant<cell::Started, cell::CommandRefusal>& given) {
                          if (failure) std::rethrow_exception(failure);
                          answer = given;
                        });
  while (!answer) io_.run_one();
  return *answer;
}

void LoopbackCell::command(cell::Command command) {
  if (const auto refusal = operation_->command(command)) throw std::runtime_error(refusal->detail);
}

void LoopbackCell::run_whole(const std::string& recipe, const cell::Truth& truth) {
  serve(sim::make_plant(cell, truth), {.controller = {.speed = sim::kSpeedMax}});
  launch();
  run_until(cell::State::kIdle);
  start(recipe);
  run_until_over();
}

void LoopbackCell::leave_aborted() {
  command(cell::Command::kClear);
  run_until(cell::State::kStopped);
  command(cell::Command::kReset);
  run_until(cell::State::kIdle);
}

bool LoopbackCell::is_refused(cell::Command command) { return operation_->command(command).has_value(); }

std::string LoopbackCell::fault_name() const {
  const cell::Status status = operation_->status();
  return status.fault ? std::string(cell::describe(status.fault->code).name) : std::string();
}

}  // namespace touchcal::testing
