#include "tests/simulation/world.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>

#include "tests/simulation/invariants.hpp"
#include "tests/simulation/running_world.hpp"
#include "tests/simulation/store_reading.hpp"

namespace simulation {
namespace {

using namespace std::chrono_literals;

/// Who does what the cell asks for is at the end of the last run long before.
constexpr Time kPatience = 3h;
/// The daemon's log, as lines of the journal.
class LogSink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  explicit LogSink(Watcher& watcher) : watcher_(watcher) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    watcher_.on_log({message.payload.data(), message.payload.size()});
  }
  void flush_() override {}

 private:
  Watcher& watcher_;
};

}  // namespace

World::World(const Scenario& scenario)
    : scenario_(scenario),
      controller_(cell_context_, "127.0.0.1", kControllerPort, setting().plant,
                  {.controller = {.seed = scenario.seed,
                                  .speed = scenario.speed,
                                  .duties = {.frees_arm = scenario.script.empty()}},
                   .faults = {}}),
      person_(scenario.seed + 3, controller_, journal_, [this] { start_run(); }),
      plan_(first_touches(*setting().plan, scenario.touch_count)) {
  record_.touches_planned = static_cast<int>(plan_->touches.touches.size());
  auto log = std::make_shared<spdlog::logger>("simulation", std::make_shared<LogSink>(watcher_));
  log->set_level(spdlog::level::info);
  spdlog::set_default_logger(std::move(log));
  network_.cable_port = kControllerPort;
  network_.tap = [this](bool from_host, bool sent, std::span<const std::uint8_t> bytes) {
    watcher_.on_bytes(from_host, sent, bytes);
  };
  network_.on_connection = [this] { watcher_.on_connection(); };
  network_.on_host_close = [this] { watcher_.on_connection_end(); };
  if (!scenario.script.empty()) {
    person_.go_by_words();
    watcher_.on_sight = [this](std::string_view sight) {
      rest_.see(sight);
      script_.see(sight);
    };
  }
  disk_.on_write = [this](bool is_sync) {
    is_sync ? watcher_.on_disk_sync() : rest_.on_write();
    if (is_sync || !process_.writes_left || --*process_.writes_left > 0) return;
    process_.writes_left.reset();
    process_.dies_now = true;
    disk_.freeze();
    network_.silence_host();
  };
  disk_.keeps_unsynced = std::ranges::any_of(scenario.faults, takes_power, &DrawnFault::kind);
  for (const ScriptStep& step : scenario.script)
    disk_.keeps_unsynced |= std::ranges::any_of(step.then, takes_power, &DrawnFault::kind);
  for (const DrawnFault& fault : scenario.faults) events_.emplace(fault.at, [this, &fault] { begin(fault); });
  if (scenario.sabotage) events_.emplace(scenario.sabotaged_at, [this] { scenario_.sabotage(disk_); });
}

World::~World() {
  disk_.freeze();
  process_.daemon.reset();
  controller_.stop();
  cell_context_.give_up();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("nobody"));
}

// ---- the daemon's process ----

void World::begin_daemon() {
  try {
    process_.daemon = std::make_unique<SimulatedDaemon>(*setting().regions, plan_);
  } catch (const std::exception& error) {
    if (!process_.dies_now) {
      journal_.note("process", fmt::format("the daemon does not start: {}", error.what()));
      process_.starts_at = clock_.now() + 5s;
      return;
    }
  }
  if (process_.dies_now) return end_daemon(death_text() + " while it starts");
  journal_.note("process", "the daemon starts");
  cell::CellOperation& operation = process_.daemon->operation();
  watcher_.watch(&operation);
  process_.daemon->on_change([this](const cell::Status& status) { watcher_.on_status(status); });
  note_store("the daemon starts", false);
  process_.daemon->launch();
  poke();
}

void World::end_daemon(const std::string& how) {
  journal_.note("process", how);
  disk_.freeze();
  network_.silence_host();
  process_.daemon.reset();
  watcher_.watch(nullptr);
  network_.new_host();
  if (process_.power_fails && disk_.has_failed()) watcher_.on_power_failure_of_failed_disk();
  disk_.start_again(process_.power_fails);
  const Time starts_at = clock_.now() + 2s;
  process_ = {};
  process_.starts_at = starts_at;
}

std::string World::death_text() const {
  return process_.power_fails ? "the power of the daemon's machine fails" : "the daemon is killed";
}

void World::kill_if_due() {
  if (!process_.daemon) return;
  if (process_.dies_now) {
    end_daemon(death_text());
  } else if (process_.daemon->has_ended()) {
    end_daemon("the daemon has ended");
  } else if (process_.killed_by && *process_.killed_by <= clock_.now()) {
    end_daemon("the daemon does not end in time and is killed");
  }
}

void World::note_store(const std::string& occasion, bool with_results) {
  watcher_.note_store(occasion,
                      read_runs(process_.daemon->store(), with_results ? setting().regions.get() : nullptr));
}

void World::start_run() {
  const cell::StartRequest request{.recipe = kRecipe};
  boost::asio::co_spawn(process_.daemon->context(), process_.daemon->operation().start(request),
                        [this](const std::exception_ptr& failure,
                               const std::variant<cell::Started, cell::CommandRefusal>& answer) {
                          if (failure) std::rethrow_exception(failure);
                          if (const auto* started = std::get_if<cell::Started>(&answer)) {
                            journal_.note("person", fmt::format("has started run {}", started->run.id));
                            person_.on_started();
                          } else {
                            const auto& refusal = std::get<cell::CommandRefusal>(answer);
                            journal_.note("person", fmt::format("may not start: {}", refusal.detail));
                            rest_.see(refusal_text(refusal));
                          }
                        });
}

// ---- time ----

/// What is due now.
void World::let_happen() {
  while (!events_.empty() && events_.begin()->first <= clock_.now()) {
    const std::function<void()> event = std::move(events_.begin()->second);
    events_.erase(events_.begin());
    event();
    kill_if_due();
    poke();
  }
  clients_.ask_again();
  if (!process_.daemon && process_.starts_at <= clock_.now()) begin_daemon();
  if (person_.next_look() > clock_.now()) return;
  const bool is_left_alone = !scenario_.script.empty() && !rest_.is_over();
  if (process_.daemon && !process_.killed_by && !is_left_alone) {
    person_.look(process_.daemon->operation(), clock_.now());
    poke();
  } else {
    person_.wait(clock_.now());
  }
}

/// A side that has done all it can at this time is left alone until its next timer, or until something
/// reaches it: nine of ten ticks of the controller concern nobody else.
void World::take_turn_of_daemon() {
  const bool store_goes_on = process_.store_answers_at <= clock_.now();
  if (process_.daemon->take_turn(store_goes_on)) {
    cell_due_ = clock_.now();  // it may have connected
  } else {
    const auto next = process_.daemon->until_next_timer();
    process_.due = clock_.now() + next.value_or(1h);
  }
  kill_if_due();
}

/// Until nobody has anything to do at this time.
void World::take_turns() {
  const auto daemon_is_due = [this] { return process_.daemon && process_.due <= clock_.now(); };
  do {
    if (network_.deliver()) {
      clients_.go_on();
      poke();
    }
    strike_due();
    if (daemon_is_due()) take_turn_of_daemon();
    strike_due();
    if (cell_due_ <= clock_.now()) cell_due_ = clock_.now() + cell_context_.until_next_timer().value_or(1h);
  } while (daemon_is_due() || cell_due_ <= clock_.now());
}

Time World::next_event() const {
  Time next = std::min({person_.next_look(), cell_due_, clock_.now() + 1h});
  const auto consider = [&next](Time time) { next = std::min(next, time); };
  if (!events_.empty()) consider(events_.begin()->first);
  if (const auto due = network_.next_due()) consider(*due);
  if (const auto due = clients_.next_due()) consider(*due);
  consider(process_.daemon ? process_.due : process_.starts_at);
  if (process_.killed_by) consider(*process_.killed_by);
  return next;
}

void World::go_on_to_end() {
  while (clock_.now() < kPatience) {
    let_happen();
    take_turns();
    look_for_rest();
    record_.came_to_end = person_.is_done() && process_.daemon && !process_.killed_by;
    if (record_.came_to_end) break;
    clock_.advance_to(next_event());
  }
  clients_.end();
  record_.person_did.assign(person_.given().begin() + given_before_rest_, person_.given().end());
  if (!process_.daemon) return;
  note_store("the end", true);
  for (const RunRecord& run : record_.stores.back().runs)
    for (const std::string& reason : run.reasons)
      journal_.note("watcher", fmt::format("run {} is not accepted: {}", run.run.id, reason));
}

Outcome World::run() {
  try {
    go_on_to_end();
  } catch (const std::exception& error) {
    record_.thrown = error.what();
  }
  Outcome outcome;
  outcome.broken = broken_invariants(record_);
  for (const std::string& broken : outcome.broken) journal_.note("invariant", broken);
  outcome.virtual_time = clock_.now();
  outcome.journal = journal_.text();
  outcome.record = record_;
  return outcome;
}

Scenario scenario_of(std::uint64_t seed) {
  Chance chance(seed * 2);
  Scenario scenario{.seed = seed};
  const int whole = static_cast<int>(setting().plan->touches.touches.size());
  scenario.touch_count = seed % 100 == 99 ? whole : kTouchesMin + chance.below(kTouchesMax - kTouchesMin + 1);
  scenario.speed = chance.once_in(4) ? 1.0 : kQuickSpeed;
  scenario.faults = draw_faults(seed, scenario.touch_count);
  return scenario;
}

Outcome run_world(const Scenario& scenario) {
  World world(scenario);
  return world.run();
}

}  // namespace simulation
