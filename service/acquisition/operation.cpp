#include "service/acquisition/operation.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "cs8_protocol/names.hpp"
#include "service/base/log_format.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/configuration_digest.hpp"
#include "service/documents/result_view.hpp"
#include "service/run/run_conditions.hpp"
#include "service/run/touch_command.hpp"
#include "service/store/fault_log.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// How long the end waits for the controller's last answer, and for what that leaves to be stored.
constexpr std::chrono::milliseconds kStopPatience{3000};
constexpr std::chrono::milliseconds kRetractPatience{10'000};  // as long as the arm still moves then
constexpr std::chrono::milliseconds kClosePatience{1000};

cs8::ClientOptions client_options(const Deadlines& deadlines) {
  return {.connect_deadline = deadlines.connect, .heartbeat_timeout = deadlines.heartbeat_timeout};
}

FaultCode fault_code_of(cs8::LinkErrorKind kind) {
  switch (kind) {
    case cs8::LinkErrorKind::kIncompatible:
      return FaultCode::kControllerIncompatible;
    case cs8::LinkErrorKind::kProtocol:
    case cs8::LinkErrorKind::kFault:
      return FaultCode::kProtocolError;
    case cs8::LinkErrorKind::kUnreachable:
    case cs8::LinkErrorKind::kHandshakeTimeout:
    case cs8::LinkErrorKind::kNotConnected:
      return FaultCode::kControllerUnreachable;
    case cs8::LinkErrorKind::kUnanswered:
      return FaultCode::kAnswerMissing;
    default:
      return FaultCode::kLinkLost;
  }
}

}  // namespace

bool is_link_fault(FaultCode code) {
  switch (code) {
    case FaultCode::kControllerUnreachable:
    case FaultCode::kControllerIncompatible:
    case FaultCode::kProtocolError:
    case FaultCode::kLinkLost:
    case FaultCode::kAnswerMissing:
      return true;
    default:
      return false;
  }
}

Fault link_fault(const cs8::LinkError& error) { return {fault_code_of(error.kind), error.text}; }

Operation::Operation(asio::any_io_executor executor, const Cell& cell, RunStore& store, Endpoint controller,
                     std::string instance_id, Clock clock)
    : executor_(executor),
      configured_(cell),
      cell_(cell),
      tip_regions_(std::in_place, cell_),
      store_(store),
      endpoint_(std::move(controller)),
      clock_(std::move(clock)),
      client_(executor, client_options(cell.deadlines),
              {.on_state = [this](const cs8::State& state) { hear(state); },
               .on_permit = [this](const cs8::Permit& permit) { hear_permit(permit); },
               .on_loss = [this](const cs8::LinkError& error) { lose(error); }}),
      wake_(executor),
      ended_(executor, asio::steady_timer::time_point::max()) {
  config_digest_ = configuration_digest(cell_);
  status_.instance_id = std::move(instance_id);
  status_.since = now_text();
  if (const auto accepted = store_.last_accepted()) {
    status_.last_accepted_run_id = accepted->id;
    status_.last_accepted_at = accepted->ended_at;
  }
}

Operation::~Operation() { planner_.join(); }

std::string Operation::now_text() const { return format_utc(clock_()); }

void Operation::launch() {
  restore_run();
  enter(interrupted_ ? State::kHeld : State::kResetting);  // finding the controller moves nothing
  driving_ = true;
  asio::co_spawn(executor_, drive(), [this](const std::exception_ptr& failure) {
    driving_ = false;
    ended_.cancel();
    if (failure) std::rethrow_exception(failure);
  });
}

void Operation::enter(State state) {
  if (state == status_.state) return;
  spdlog::info("{} -> {}{}", state_name(status_.state), state_name(state),
               run_ ? fmt::format(" (run {})", run_->id()) : "");
  status_.state = state;
  status_.since = now_text();
  if (state == State::kStopping || state == State::kAborting) client_.stop();
  if (asking_) client_.finish();
  publish();
  wake_.cancel();
}

void Operation::apply(Event event) { enter(after_event(status_.state, event)); }

void Operation::raise(Fault fault, Event event) {
  const std::string name(describe(fault.code).name);
  spdlog::warn("fault {}: {}", name, fault.message());
  try {
    FaultLog(store_.database())
        .append(run_open_ ? std::optional(run_->id()) : std::nullopt, now_text(), name, fault.message());
  } catch (const std::exception& error) {
    spdlog::error("the fault could not be stored: {}", error.what());
  }
  status_.fault = std::move(fault);
  publish();
  apply(event);
}

void Operation::publish() {
  ++status_.sequence;
  status_.controller = controller_view();
  // Each line of the log tells the run, and the touch under way or next.
  set_logged_run(run_open_ ? std::optional(run_->id()) : std::nullopt);
  set_logged_touch(run_open_ && run_->next() ? std::optional(run_->touches_done() + 1) : std::nullopt);
  status_.touches_done = run_ ? run_->touches_done() : 0;
  status_.touches_total = run_ ? run_->touches_total() : 0;
  status_.identifiable_count.reset();
  status_.condition_number.reset();
  status_.predicted_tip_rms_m.reset();
  status_.touch_benefit.reset();
  status_.eta_s.reset();
  status_.plane.reset();
  if (run_) {
    status_.run_id = run_->id();
    status_.recipe = run_->recipe().name;
    const calib::IdentificationResult& latest = run_->latest();
    if (run_->touches_done() > 0)
      status_.identifiable_count = static_cast<int>(latest.identifiable.columns.size());
    if (latest.status == calib::IdentificationStatus::kConverged)
      status_.condition_number = latest.iterations.back().condition_number;
    status_.predicted_tip_rms_m = run_->predicted_tip_rms_m();
    status_.touch_benefit = run_->touch_benefit();
    if (is_active(status_.state)) {
      if (const calib::PlannedTouch* next = run_->next()) status_.plane = next->face + 1;
      if (run_->touches_done() > 0) {
        const std::chrono::duration<double> elapsed = clock_() - run_began_;
        status_.eta_s = run_->remaining_s(elapsed.count());
      }
    }
  }
  tell_guide();
  if (told_) told_(status_);
}

ControllerView Operation::controller_view() const {
  ControllerView view{.connected = client_.connected()};
  const auto state = client_.latest_state();
  if (!view.connected || !state) return view;
  view.powered = (state->flags & cs8::kPowered) != 0;
  view.emergency_stop = state->emergency_stop != 0;
  view.mode = std::string(cs8::name(state->mode));
  view.cell_closed = (state->flags & cs8::kCellClosed) != 0;
  view.touch_tested = (state->flags & cs8::kTouchTested) != 0;
  view.permit = std::string(cs8::name(state->permit));
  const cs8::ProbeInputs probe = cs8::probe_inputs(state->flags);
  if (probe.agree()) {
    view.probe = probe.free() ? "free" : "touched";
  } else {
    view.probe = inputs_disagree_count_ > 1 ? std::optional("fault") : status_.controller.probe;
  }
  return view;
}

void Operation::hear(const cs8::State& state) {
  // The two inputs of a probe may change up to 20 ms apart, the time between two states.
  inputs_disagree_count_ = cs8::probe_inputs(state.flags).agree() ? 0 : inputs_disagree_count_ + 1;
  if (status_.controller != controller_view()) publish();
  const bool watched = status_.state == State::kResetting || status_.state == State::kSuspended;
  if (watched || status_.waiting_for) wake_.cancel();
  if (is_active(status_.state) && overruns_ && state.overruns > *overruns_)
    warn({FaultCode::kControllerOverruns, fmt::format("{} since its start", state.overruns)});
  overruns_ = state.overruns;
  constexpr double kMovedRad = 1e-3;
  if (standing_ && status_.state == State::kExecute && state.active_sequence == 0 &&
      (from_wire(state.joints) - *standing_).cwiseAbs().maxCoeff() > kMovedRad) {
    standing_.reset();
    warn({FaultCode::kArmMoved, {}});
  }
  told_at_ = std::chrono::steady_clock::now();
  hear_by_hand(state);
  if (std::exchange(task_error_, state.task_error) != state.task_error && state.task_error != 0) {
    raise({FaultCode::kTaskFailed, fmt::format("run-time error {}", state.task_error)}, Event::kAbortFault);
  }
}

void Operation::lose(const cs8::LinkError& error) {
  if (shutting_down_) return;
  standing_.reset();
  const bool is_over = status_.state == State::kAborted || status_.state == State::kStopped;
  if (is_over && status_.fault) {
    publish();  // the fault that is there stays until somebody has read it
  } else {
    raise(link_fault(error), link_down());
  }
  wake_.cancel();
}

std::variant<Started, CommandRefusal> Operation::start(const StartRequest& request) {
  const std::string& recipe = request.recipe;
  if (request.idempotency_key) {
    if (const auto earlier = store_.run_with_key(*request.idempotency_key)) {
      if (earlier->recipe == recipe) return Started{earlier->id, true};
      return CommandRefusal{
          .kind = CommandRefusal::Kind::kOtherKey,
          .detail = fmt::format("this Idempotency-Key already started run {} with the recipe '{}'",
                                earlier->id, earlier->recipe)};
    }
  }
  const auto found = cell_.recipes.find(recipe);
  if (found == cell_.recipes.end()) {
    std::string known;
    for (const auto& [name, unused] : cell_.recipes) known += (known.empty() ? "" : ", ") + name;
    return CommandRefusal{.kind = CommandRefusal::Kind::kUnknownRecipe,
                          .detail = fmt::format("there is no recipe '{}'; this cell has {}", recipe, known)};
  }
  if (shutting_down_) return CommandRefusal{.detail = "the daemon is ending"};
  if (is_active(status_.state)) {
    return CommandRefusal{
        .detail = fmt::format("run {} is active; stop or abort it first", run_ ? run_->id() : 0),
        .code = FaultCode::kRunActive};
  }
  auto unmet = request.guided ? unmet_for_hands(recipe) : unmet_for(recipe);
  if (!unmet.empty()) {
    return CommandRefusal{.kind = CommandRefusal::Kind::kPreconditions,
                          .detail = "the cell is not ready",
                          .unmet = std::move(unmet)};
  }
  const bool waits_for_remote = request.guided && status_.state == State::kResetting;
  if (!waits_for_remote && !after_command(status_.state, Command::kStart)) {
    return CommandRefusal{
        .detail = fmt::format("a run cannot start in the state {}", state_name(status_.state)),
        .code = FaultCode::kNotInThisState};
  }
  const std::string conditions =
      conditions_document(cell_, {.operator_name = request.operator_name,
                                  .config_digest = config_digest_,
                                  .controller_application = controller_application_,
                                  .controller_session = session_,
                                  .touch_mode = request.guided ? TouchMode::kGuided : TouchMode::kAutomatic,
                                  .place = place_});
  std::int64_t id = 0;
  try {
    id = store_.begin_run({.recipe = recipe,
                           .started_at = now_text(),
                           .idempotency_key = request.idempotency_key,
                           .operator_name = request.operator_name,
                           .block_temperature_c = cell_.block.temperature_c,
                           .config_digest = config_digest_,
                           .conditions_json = conditions});
  } catch (const std::exception& error) {
    return CommandRefusal{
        .kind = CommandRefusal::Kind::kPreconditions,
        .detail = "the cell is not ready",
        .unmet = {{"store_not_writable",
                   fmt::format("free disk space or mend the state directory: {}", error.what())}}};
  }
  run_.emplace(id, *tip_regions_, found->second, now_text());
  conditions_ = conditions;
  run_open_ = true;
  set_logged_run(id);
  run_finished_ = false;
  begin_checks();
  guided_ = request.guided;
  stored_changes_ = 0;
  status_.fault.reset();
  status_.verdict = Verdict::kNone;
  enter(State::kStarting);
  return Started{id, false};
}

std::optional<CommandRefusal> Operation::command(Command command, std::optional<std::int64_t> run_id) {
  if (run_id && (!run_ || run_->id() != *run_id)) {
    return CommandRefusal{.kind = CommandRefusal::Kind::kNotThisRun,
                          .detail = fmt::format("run {} is over", *run_id)};
  }
  const auto next = after_command(status_.state, command);
  if (!next) {
    return CommandRefusal{.detail = fmt::format("{} is not possible in the state {}", command_name(command),
                                                state_name(status_.state)),
                          .code = FaultCode::kNotInThisState};
  }
  if (auto refusal = objection(command)) return refusal;
  if (command == Command::kLocate) return locate();
  if (command == Command::kTake) return take();
  if (command == Command::kUndo) return undo();
  spdlog::info("command {}", command_name(command));
  const State state = status_.state;
  heed(command);
  if (status_.state == state) enter(*next);
  return std::nullopt;
}

std::optional<std::int64_t> Operation::data_age_ms() const {
  const auto heard = client_.heard_at();
  if (!heard) return std::nullopt;
  const auto age = std::chrono::steady_clock::now() - *heard;
  return std::chrono::duration_cast<std::chrono::milliseconds>(age).count();
}

Status Operation::status() const {
  Status status = status_;
  status.data_age_ms = data_age_ms();
  return status;
}

std::optional<std::string> Operation::result_json() const {
  if (!run_ || run_->latest().status != calib::IdentificationStatus::kConverged) return std::nullopt;
  return result_document(*tip_regions_, run_->recipe(), run_->problem(), run_->latest(),
                         {.complete = run_finished_, .warnings = {}, .conditions = conditions_});
}

std::optional<PlanOutcome> Operation::planned(const std::string& recipe) const {
  const auto found = plans_.find(recipe);
  return found == plans_.end() ? std::nullopt : std::optional(found->second);
}

std::shared_ptr<const Plan> Operation::plan_with_id(const std::string& id) const {
  for (const auto& [recipe, outcome] : plans_) {
    const auto* plan = std::get_if<std::shared_ptr<const Plan>>(&outcome);
    if (plan && (*plan)->id == id) return *plan;
  }
  return nullptr;
}

asio::awaitable<void> Operation::shut_down() {
  shutting_down_ = true;
  if (is_active(status_.state) && status_.state != State::kAborting && !interrupted_) {
    enter(State::kStopping);
  } else {
    wake_.cancel();
  }
  co_await wait_for_end(kStopPatience);
  const auto told = client_.latest_state();
  if (told && told->active_sequence != 0) co_await wait_for_end(kRetractPatience);
  client_.close();  // what still waits for the controller ends now
  co_await wait_for_end(kClosePatience);
}

asio::awaitable<void> Operation::wait_for_end(std::chrono::milliseconds at_most) {
  if (!driving_) co_return;
  ended_.expires_after(at_most);
  boost::system::error_code ignored;
  co_await ended_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
}

}  // namespace cell
