// How a CellOperation starts a run. Each co_await stands alone in its statement, see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "config/mounted_tool.hpp"
#include "service/acquisition/cell_operation.hpp"
#include "service/acquisition/past_calibration.hpp"
#include "service/acquisition/past_qualification.hpp"
#include "service/acquisition/preconditions.hpp"
#include "service/base/log_format.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {

namespace asio = boost::asio;

std::vector<Unmet> CellOperation::unmet_for(const StartRequest& request) const {
  const auto outcome = plans_.planned(request.recipe, given_to(request, cell()));
  const auto* no_plan = outcome ? std::get_if<PlanRefusal>(&*outcome) : nullptr;
  auto met_by_all = unmet_whatever_is_given();
  if (request.kind == RunKind::kTool)
    std::erase_if(met_by_all, [](const Unmet& one) { return one.code == kProbeNotMounted; });
  auto unmet = unmet_for_run(std::move(met_by_all), cell(), {request.block_temperature, clocks_.system()},
                             status_.fault(), no_plan);
  return request.guided ? unmet_without_motion(std::move(unmet)) : unmet;
}

/// The answer to a start whose Idempotency-Key was there before; nothing when it was not.
std::optional<std::variant<Started, CommandRefusal>> CellOperation::repeated_start(
    const StartRequest& request, const Earlier& earlier) {
  const auto& same = earlier.with_key;
  if (!same) return std::nullopt;
  const bool is_same = request.kind == RunKind::kCalibration
                           ? same->recipe == request.recipe
                           : (!request.of_run || same->of_run == request.of_run) &&
                                 touching_tool(same->conditions_json).value_or("") == request.tool;
  if (same->kind == request.kind && is_same) return Started{*same, true};
  return CommandRefusal{
      .kind = CommandRefusal::Kind::kOtherKey,
      .detail = fmt::format("this Idempotency-Key already started run {} with the recipe '{}'", same->id,
                            same->recipe)};
}

CommandRefusal CellOperation::refusal_at_the_end() { return {.detail = "the daemon is ending"}; }

std::optional<CommandRefusal> CellOperation::refuse_start(const StartRequest& request) const {
  if (!cell().recipes.contains(request.recipe)) {
    std::string known;
    for (const auto& [name, unused] : cell().recipes) known += (known.empty() ? "" : ", ") + name;
    return CommandRefusal{
        .kind = CommandRefusal::Kind::kUnknownRecipe,
        .detail = fmt::format("there is no recipe '{}'; this cell has {}", request.recipe, known)};
  }
  if (status_.is_ending()) return refusal_at_the_end();
  const State state = status_.state();
  if (is_active(state)) {
    return CommandRefusal{
        .detail = fmt::format("run {} is active; stop or abort it first", run_ ? run_->run.id() : 0),
        .code = FaultCode::kRunActive};
  }
  auto unmet = unmet_for(request);
  if (!unmet.empty()) {
    return CommandRefusal{.kind = CommandRefusal::Kind::kPreconditions,
                          .detail = "the cell is not ready",
                          .unmet = std::move(unmet)};
  }
  const bool waits_for_remote = request.guided && state == State::kResetting && !way_back_.is_under_way();
  const bool has_open_touch = session_.open_touch() || session_.sequence_to_settle() != 0;
  if (is_settling_ || (waits_for_remote && has_open_touch))
    return CommandRefusal{.detail = "a touch of the last run is still to be stored; then once more",
                          .code = FaultCode::kNotInThisState};
  if (!waits_for_remote && !after_command(state, Command::kStart)) {
    return CommandRefusal{.detail = fmt::format("a run cannot start in the state {}", state_name(state)),
                          .code = FaultCode::kNotInThisState};
  }
  return std::nullopt;
}

asio::awaitable<std::variant<Started, CommandRefusal>> CellOperation::start(StartRequest request) {
  std::variant<Started, CommandRefusal> answer =
      CommandRefusal{.detail = "another start is under way", .code = FaultCode::kRunActive};
  if (is_starting_) co_return answer;
  if (status_.is_ending()) co_return refusal_at_the_end();  // the end waits for none that comes now
  is_starting_ = true;
  std::optional<std::string> failure;
  try {
    answer = co_await start_alone(request);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  is_starting_ = false;
  loop_.ended.wake();  // the end of the daemon may wait for it
  if (failure)
    answer = CommandRefusal{
        .kind = CommandRefusal::Kind::kPreconditions,
        .detail = "the cell is not ready",
        .unmet = {{"store_not_writable",
                   fmt::format("free disk space or repair the state directory: {}", *failure)}}};
  co_return answer;
}

/// Sets what the touches are held against, and of a proof or a check the recipe and choices of its
/// calibration. Throws what the store throws.
asio::awaitable<std::optional<CommandRefusal>> CellOperation::find_verification(StartRequest& request) {
  const auto refusal = [](std::string message) {
    return CommandRefusal{.kind = CommandRefusal::Kind::kPreconditions,
                          .detail = "the cell is not ready",
                          .unmet = {{"no_calibration_to_hold_against", std::move(message)}}};
  };
  const auto read = [kind = request.kind, of_run = request.of_run, digest = recovery_.config_digest()](
                        RunStore& store) { return find_calibration(store, kind, of_run, digest); };
  auto found = co_await store_.run(read);
  const auto* refused = std::get_if<VerificationRefusal>(&found);
  if (refused && request.kind == RunKind::kQualification && !request.of_run) {
    request.recipe = cell().default_recipe;
    request.verification = qualification_alone(refused->message);
    co_return std::nullopt;
  }
  if (refused && refused->is_unknown_run)
    co_return CommandRefusal{.kind = CommandRefusal::Kind::kUnknownRun, .detail = refused->message};
  if (refused) co_return refusal(refused->message);
  PastCalibration past = std::get<PastCalibration>(std::move(found));
  if (!request.recipe.empty() && request.recipe != past.run.recipe)
    co_return refusal(
        fmt::format("run {} was made by the recipe '{}' and not '{}': leave the recipe out, or name "
                    "the run of another calibration",
                    past.run.id, past.run.recipe, request.recipe));
  request.recipe = past.run.recipe;
  request.stiffness = stiffness_choice_named(past.run.stiffness.value_or(""));
  VerificationOutcome made = co_await computation_.verification(
      request.kind, std::move(past), with_block_temperature(cell(), request.block_temperature),
      place() ? place()->cell_from_block : Eigen::Isometry3d::Identity(), request.tool);
  if (const auto* not_made = std::get_if<VerificationRefusal>(&made)) co_return refusal(not_made->message);
  request.verification = std::get<std::shared_ptr<const Verification>>(std::move(made));
  if (request.of_run && !request.verification->of_run) co_return refusal(request.verification->no_record);
  request.of_run = request.verification->of_run;
  co_return std::nullopt;
}

/// Throws what the store throws.
asio::awaitable<std::variant<Started, CommandRefusal>> CellOperation::start_alone(StartRequest request) {
  const auto read = [key = request.idempotency_key](RunStore& store) {
    return Earlier{.with_key = key ? store.run_with_key(*key) : std::nullopt, .last = run_page(store, 1, {})};
  };
  const Earlier earlier = co_await store_.run(read);
  if (auto repeated = repeated_start(request, earlier)) co_return *std::move(repeated);
  look_for_lost_place(earlier.last);
  if (request.kind == RunKind::kTool && !cell().tool_tips.contains(request.tool))
    co_return CommandRefusal{.kind = CommandRefusal::Kind::kUnknownRecipe,
                             .detail = why_no_tip(cell(), request.tool)};
  if (request.kind != RunKind::kCalibration) {
    auto refusal = co_await find_verification(request);
    if (refusal) co_return *std::move(refusal);
  } else if (!request.guided) {  // a hand touches otherwise than the arm
    const auto find = [digest = recovery_.config_digest(), now = clocks_.system()](RunStore& store) {
      return qualification_that_counts(store, digest, now);
    };
    request.qualified = co_await store_.run(find);
  }
  if (auto refusal = refuse_start(request)) co_return *std::move(refusal);
  // An ended run that cannot be read forbids no other: nothing of it is needed any more.
  for (const DamagedRun& run : earlier.last.damaged) spdlog::error("beside a damaged run: {}", run.what);
  const NewRun begun = new_run(request);
  const auto write = [begun](RunStore& store) {
    const std::int64_t id = store.begin_run(begun);
    return store.run(id).value();
  };
  StoredRun stored = co_await store_.run(write);
  const std::int64_t id = stored.id;
  // Meanwhile a person may have stopped the cell, or its link may have gone.
  if (auto refusal = refuse_start(request)) {
    co_await give_up(id);
    co_return *std::move(refusal);
  }
  run_.emplace(
      ActiveRun{.run = Run(id, tip_regions(), recipe_of(request, cell()), begun.started_at,
                           request.block_temperature, request.verification,
                           request.qualified ? std::optional(request.qualified->noise) : std::nullopt),
                .conditions = begun.conditions_json.value_or(""),
                .guided = request.guided,
                .interruption = std::nullopt,
                .place_check = std::nullopt,
                .block_is_away = block_is_away_});
  set_logged_run(id);
  touches_.begin_run(*run_);
  manual_.begin_run();
  status_.begin_run(id);
  look_for_tool(stored);
  status_.enter(State::kStarting);
  co_return Started{std::move(stored), false};
}

NewRun CellOperation::new_run(const StartRequest& request) const {
  std::string conditions = conditions_document(
      with_block_temperature(cell(), request.block_temperature),
      {.operator_name = request.operator_name,
       .config_digest = recovery_.config_digest(),
       .controller_application = session_.application(),
       .controller_session = session_.number(),
       .touch_mode = request.guided ? TouchMode::kGuided : TouchMode::kAutomatic,
       .temperature_source = request.block_temperature ? TemperatureSource::kRun : TemperatureSource::kFile,
       .arm_moving_min = request.arm_moving_min,
       .place = place(),
       .qualified = request.qualified,
       .tool = request.tool.empty() ? std::nullopt : std::optional(request.tool)});
  return {.kind = request.kind,
          .of_run = request.of_run,
          .recipe = request.recipe,
          .started_at = now_text(),
          .idempotency_key = request.idempotency_key,
          .operator_name = request.operator_name,
          .block_temperature = temperature_to_store(cell(), request.block_temperature),
          .stiffness = stiffness_to_store(request),
          .config_digest = recovery_.config_digest(),
          .conditions_json = std::move(conditions)};
}

/// A run that was begun in the store and nowhere else: the same key may start another one.
asio::awaitable<void> CellOperation::give_up(std::int64_t run_id) {
  const auto write = [run_id](RunStore& store) { store.withdraw_run(run_id); };
  const auto failure = co_await store_.write(write);
  if (failure) spdlog::error("run {} never began and is still stored: {}", run_id, *failure);
}

namespace {

/// Of a run whose changes cannot be read: where the block can be elsewhere, it is asked for.
std::optional<bool> is_block_away_after(const RunStore& store, std::int64_t run_id, bool has_places) try {
  return is_block_away(store.plan_changes(run_id));
} catch (const std::exception& error) {
  spdlog::error("run {}: where it left the block cannot be read: {}", run_id, error.what());
  return has_places ? std::optional(true) : std::nullopt;
}

/// Runs in which the block can have been moved, newest first.
constexpr int kRunsLookedAt = 100;

/// The newest run that this daemon made: one that was imported says nothing of what is on the arm.
std::optional<StoredRun> newest_own_run(const RunStore& store) {
  constexpr int kLookedAtOnce = 20;
  std::optional<std::int64_t> before;
  do {
    RunPage page = run_page(store, kLookedAtOnce, before);
    for (StoredRun& run : page.runs)
      if (!run.origin) return std::move(run);
    before = page.next_before;
  } while (before);
  return std::nullopt;
}

}  // namespace

/// Of the daemon before: the newest of its runs that says something of the block, unless somebody has located
/// the block since that run began.
void CellOperation::look_for_block() {
  for (const StoredRun& run : run_page(store_.store(), kRunsLookedAt, {}).runs) {
    if (run.origin) continue;
    const auto away = is_block_away_after(store_.store(), run.id, !cell().block.places.empty());
    if (!away) continue;
    const bool was_located_since = place() && place()->located_at > run.started_at;
    block_is_away_ = *away && !was_located_since;
    return;
  }
}

/// Of the daemon before: nobody may have taken the tool off since.
void CellOperation::look_for_mounted_tool() {
  if (const auto newest = newest_own_run(store_.store())) look_for_tool(*newest);
}

void CellOperation::look_for_tool(const StoredRun& last) {
  if (last.kind == RunKind::kTool) run_of_tool_ = last.id;
}

std::optional<Unmet> CellOperation::unmet_by_tool() const {
  if (!run_of_tool_) return std::nullopt;
  return Unmet{
      kProbeNotMounted,
      fmt::format("run {} touched with a tool: mount the probe in its place, touch its stylus by hand, then "
                  "touchcal touch-test says so",
                  *run_of_tool_)};
}

}  // namespace cell
