// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/run_recovery.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "config/mounted_tool.hpp"
#include "service/acquisition/commanded_touch.hpp"
#include "service/acquisition/past_calibration.hpp"
#include "service/acquisition/restored_touches.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/configuration_digest.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/run_recipe.hpp"
#include "service/store/damaged_store.hpp"

namespace cell {

namespace asio = boost::asio;

std::optional<std::string> why_not_resumable(const Cell& cell, const StoredRun& run,
                                             const std::optional<std::string>& config_digest) {
  if (!cell.recipes.contains(run.recipe)) return fmt::format("the cell has no recipe '{}' now", run.recipe);
  if (run.config_digest != config_digest) return "the cell's files are not those of the run";
  return std::nullopt;
}

std::string kept_words(const std::string& why) {
  return fmt::format(
      "it cannot be resumed: {}; start touchcald with the files that the run had, or end it with touchcal "
      "stop",
      why);
}

RunRecovery::RunRecovery(const Cell& cell, const std::optional<BlockPose>& place, const TipRegions& regions,
                         StoreQueue& store, PlanCache& plans, ControllerSession& session,
                         TouchPreparation& preparation, RunPlanning& planning, TouchExecutor& touches,
                         PublishedStatus& status, Clocks clocks)
    : cell_(cell),
      place_(place),
      regions_(regions),
      store_(store),
      plans_(plans),
      session_(session),
      preparation_(preparation),
      planning_(planning),
      touches_(touches),
      status_(status),
      clocks_(std::move(clocks)),
      config_digest_(configuration_digest(cell)) {}

std::optional<ActiveRun> RunRecovery::restore() {
  const std::optional<StoredRun> stored = open_run();
  store_.store().finish_interrupted(format_utc(clocks_.system()),
                                    stored ? std::optional(stored->id) : std::nullopt);
  if (!stored) return std::nullopt;
  if (const auto why = why_not_resumable(cell_, *stored, config_digest_)) return keep_on_hold(*stored, *why);
  try {
    return take_up(*stored);
  } catch (const DamagedStore& damage) {
    end_for_good(*stored, damage.what());
    return std::nullopt;
  }
}

/// The run to take up. One that is damaged is over: nothing moves by it.
std::optional<StoredRun> RunRecovery::open_run() {
  try {
    auto stored = store_.store().running();
    // An older one was over for everybody; only its end could not be written then.
    if (stored && stored->id != store_.store().runs(1).front().id) stored.reset();
    return stored;
  } catch (const DamagedStore& damage) {
    spdlog::error("no run is taken up: {}", damage.what());
    return std::nullopt;
  }
}

std::optional<ActiveRun> RunRecovery::take_up(const StoredRun& stored) {
  const std::vector<StoredTouch> touches = store_.store().touches(stored.id);
  if (const auto why = why_no_touches_of(cell_, recipe_of(stored, cell_), touches)) {
    end_for_good(stored, *why);
    return std::nullopt;
  }
  // What is read on the way is looked at now: a person is told before anything moves.
  (void)store_.store().references(stored.id);
  (void)store_.store().superseded_touches(stored.id);
  (void)store_.store().plan_json(stored.id);
  const auto against = verification_again(stored);
  if (const auto* why = std::get_if<std::string>(&against)) {
    end_for_good(stored, *why);
    return std::nullopt;
  }
  const auto& verification = std::get<std::shared_ptr<const Verification>>(against);
  Recipe recipe = recipe_of(stored, cell_);
  if (verification) recipe = verification_recipe(cell_, recipe, stored.kind);
  ActiveRun active{
      .run = Run(stored.id, regions_, std::move(recipe), stored.started_at,
                 temperature_given_to(stored, cell_), verification, qualified_noise(stored.conditions_json)),
      .conditions = stored.conditions_json.value_or(""),
      .guided = is_guided(stored.conditions_json),
      .interruption = Interruption{stored.plan_id, store_.store().plan_changes(stored.id)},
      .place_check = std::nullopt};
  active.run.restore(touches, stored.touches_total);
  take_up_open_command(stored.id);
  status_.begin_run(stored.id);
  status_.set_fault({FaultCode::kDaemonRestarted, {}});
  spdlog::warn("run {} was interrupted after {} of {} touches; it waits to be resumed", stored.id,
               stored.touches_done, stored.touches_total);
  return active;
}

/// What the touches are held against, or why that is there no more; null of a calibration.
std::variant<std::shared_ptr<const Verification>, std::string> RunRecovery::verification_again(
    const StoredRun& stored) {
  if (stored.kind == RunKind::kCalibration) return std::shared_ptr<const Verification>();
  const auto found = find_calibration(store_.store(), stored.kind, stored.of_run, config_digest_);
  if (const auto* refused = std::get_if<VerificationRefusal>(&found)) {
    // It began without one, for this reason or another.
    if (stored.kind == RunKind::kQualification && !stored.of_run)
      return qualification_alone(refused->message);
    return refused->message;
  }
  const std::string tool = touching_tool(stored.conditions_json).value_or("");
  if (stored.kind == RunKind::kTool && !cell_.tool_tips.contains(tool)) return why_no_tip(cell_, tool);
  auto made = verification_of(stored.kind, std::get<PastCalibration>(found),
                              with_block_temperature(cell_, temperature_given_to(stored, cell_)),
                              place_ ? place_->cell_from_block : Eigen::Isometry3d::Identity(), tool);
  if (const auto* refused = std::get_if<VerificationRefusal>(&made)) return refused->message;
  return std::get<std::shared_ptr<const Verification>>(std::move(made));
}

ActiveRun RunRecovery::keep_on_hold(const StoredRun& stored, const std::string& why) {
  Recipe recipe = cell_.recipes.empty() ? Recipe{} : cell_.recipes.begin()->second;  // any: nothing is fitted
  recipe.name = stored.recipe;
  ActiveRun active{.run = Run(stored.id, regions_, std::move(recipe), stored.started_at, std::nullopt),
                   .conditions = stored.conditions_json.value_or(""),
                   .interruption = Interruption{.plan_id = stored.plan_id,
                                                .plan_changes = {},
                                                .why_not = why,
                                                .touches_done = stored.touches_done,
                                                .touches_total = stored.touches_total},
                   .place_check = std::nullopt};
  status_.begin_run(stored.id);
  status_.set_fault({FaultCode::kDaemonRestarted, kept_words(why)});
  spdlog::warn("run {} was interrupted after {} of {} touches; {}", stored.id, stored.touches_done,
               stored.touches_total, kept_words(why));
  return active;
}

void RunRecovery::end_for_good(const StoredRun& run, const std::string& why) {
  spdlog::warn("run {} was interrupted and cannot be resumed: {}", run.id, why);
  RunEnd end{.outcome = RunOutcome::kInterrupted,
             .verdict = Verdict::kIncomplete,
             .ended_at = format_utc(clocks_.system())};
  end.fault_code = std::string(describe(FaultCode::kDaemonRestarted).name);
  end.fault_message = Fault{FaultCode::kDaemonRestarted, "it cannot be resumed: " + why}.message();
  store_.store().finish_run(run.id, end);
}

void RunRecovery::take_up_open_command(std::int64_t run_id) {
  const auto open = store_.store().open_command(run_id);
  if (!open) return;
  auto command = command_from_text(open->touch_json);
  if (!command)
    throw DamagedStore(store_.store().file(), "table open_commands, run " + std::to_string(run_id),
                       "it is no touch command");
  session_.set_open_touch(
      {open->session, open->sequence, std::move(command->touch), open->aimed_with, run_id});
  preparation_.set_made_path(std::move(command->path));
}

asio::awaitable<bool> RunRecovery::make_resumable(ActiveRun& active) {
  const State state = status_.state();
  const auto goes_on = [&] { return status_.state() == state && session_.connected(); };
  if (!session_.connected()) {
    const std::uint32_t sequence = co_await session_.connect(active.interruption.has_value());
    if (sequence != 0) co_await touches_.settle_open_command(&active, sequence);
  }
  if (!goes_on()) co_return false;
  if (session_.open_touch() && session_.open_touch()->session != session_.number())
    session_.drop_open_touch();  // lost with its session
  if (session_.open_touch()) co_await touches_.settle_open_command(&active, session_.open_touch()->sequence);
  if (!goes_on()) co_return false;
  if (!active.interruption) {
    if (active.run.planned(0)) co_return true;
    const bool planned = co_await planning_.plan(active);  // it was broken off before it had one
    co_return planned;
  }
  const bool planned = co_await plan_again(active);
  if (!planned || status_.state() != state) co_return false;
  const bool resumed = co_await resume(active);
  co_return resumed;
}

/// The run's plan once more: planning is deterministic, and a plan's id is the digest of its document.
asio::awaitable<bool> RunRecovery::plan_again(ActiveRun& active) {
  Run& run = active.run;
  if (!active.interruption->plan_id) {
    const bool planned = co_await planning_.plan(active);  // it was interrupted before it had one
    co_return planned;
  }
  const bool goes_on = co_await planning_.wait_for_outcome(run);
  if (!goes_on) co_return false;
  const PlanOutcome outcome = *plans_.planned(run.recipe().name, given_to(run));
  const auto* plan = std::get_if<std::shared_ptr<const Plan>>(&outcome);
  if (!plan || (*plan)->id != *active.interruption->plan_id) {
    status_.raise({FaultCode::kDaemonRestarted, kept_words("planning now gives a different plan")},
                  Event::kNotReadyFault);
    co_return false;
  }
  run.set_plan((*plan)->touches);
  for (const PlanChange& change : active.interruption->plan_changes) run.change_plan(change);
  active.stored_changes = run.plan_changes().size();
  if (const auto why = why_not_of_plan(cell_, run, active.guided)) {
    status_.raise({FaultCode::kDaemonRestarted, kept_words(*why)}, Event::kNotReadyFault);
    co_return false;
  }
  planning_.begin_touches(active);
  if (!active.guided) {
    co_await touches_.recall(active);
    co_await touches_.restore_reference(active);
    touches_.suspect_last(active);
  }
  co_return true;
}

/// From here on the run is this daemon's; its time so far is what the plan says of the touches made.
asio::awaitable<bool> RunRecovery::resume(ActiveRun& active) {
  const Run& run = active.run;
  const auto write = [id = run.id(), at = format_utc(clocks_.system()),
                      done = run.touches_done()](RunStore& store) { store.append_resumption(id, at, done); };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, Event::kNotReadyFault);
    co_return false;
  }
  active.interruption.reset();
  double made_s = 0.0;
  for (std::size_t i = 0; i < run.touches_made() && run.planned(i); ++i)
    made_s += run.planned(i)->travel_s + run.planned(i)->touch_s;
  active.worked = WorkTime(std::chrono::duration<double>(made_s));
  status_.publish();
  co_return true;
}

}  // namespace cell
