// The commands of a CellOperation, its preconditions and what it tells; what the controller tells is in
// cell_operation_link.cpp, what its states do in cell_operation_loop.cpp.
#include "service/acquisition/cell_operation.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <utility>

#include "config/touched_places.hpp"
#include "service/acquisition/cs8_controller.hpp"
#include "service/acquisition/link_fault.hpp"
#include "service/acquisition/preconditions.hpp"
#include "service/base/log_format.hpp"
#include "service/base/state_directory.hpp"
#include "service/base/utc_time.hpp"

namespace cell {

namespace asio = boost::asio;

namespace {

/// A confirmation is a key at the cell; the command says whether it is awaited and what to do.
std::optional<CommandRefusal> refuse_confirm(const Status& status) {
  if (status.waiting_for == awaited_confirmation().name) return std::nullopt;
  if (!status.waiting_for) return CommandRefusal{.detail = "nothing waits for a confirmation now"};
  return CommandRefusal{.detail =
                            fmt::format("not yet; first: {}", awaited_instruction(*status.waiting_for))};
}

std::optional<CommandRefusal> refuse_touch_test(const Status& status) {
  if (status.controller.touch_tested.value_or(false)) return std::nullopt;
  if (status.waiting_for == awaited_touch_test().name) return std::nullopt;
  if (!status.controller.connected) return CommandRefusal{.detail = "there is no link to the controller"};
  return CommandRefusal{.detail = fmt::format("the touch test is asked for once a run starts; then {}",
                                              awaited_touch_test().words)};
}

/// Where the ball was when the probe tripped is not known of a contact that is only reported by word, and the
/// stylus may be bent by then: good enough to find the block, not to calibrate with.
constexpr const char* kNoTakeInRun =
    "in a guided run a touch counts only where the controller saw the probe trip: jog back until it is free, "
    "then touch again, slowly";

/// What the status says of a run.
void describe_run(Status& status, const ActiveRun& active, const Block& block,
                  std::chrono::steady_clock::time_point now) {
  const Run& run = active.run;
  status.touches_done = run.touches_done();
  status.touches_total = run.touches_total();
  status.run_id = run.id();
  status.recipe = run.recipe().name;
  if (active.is_of_other_files()) {
    status.touches_done = active.interruption->touches_done;
    status.touches_total = active.interruption->touches_total;
    return;
  }
  const calib::IdentificationResult& latest = run.latest();
  if (run.touches_done() > 0 && run.kind() == RunKind::kCalibration)
    status.identifiable_count = static_cast<int>(latest.identifiable.columns.size());
  if (latest.status == calib::IdentificationStatus::kConverged)
    status.condition_number = latest.iterations.back().condition_number;
  status.predicted_tip_rms_m = run.predicted_tip_rms_m();
  status.touch_benefit = run.touch_benefit();
  if (!is_active(status.state) || !active.open) return;
  if (const calib::PlannedTouch* next = run.next()) status.plane = next->face + 1;
  int place = run.moving_to().value_or(run.place());
  // Of a run that waits to be resumed the plan is not read yet, nor what has changed in it.
  if (const auto last =
          active.interruption ? last_block_change(active.interruption->plan_changes) : std::nullopt)
    place = last->place;
  if (!run.recipe().places.empty() || run.moving_to())
    status.block_place = place_name(block, run.recipe(), place);
  if (run.touches_done() == 0 || active.interruption) return;  // an earlier daemon's plan is not read yet
  status.eta_s = run.remaining_s(active.worked.until(now).count());
}

}  // namespace

CellOperation::CellOperation(const Threads& threads, const Cell& cell, StoreQueue store, Endpoint controller,
                             std::string instance_id, Clocks clocks)
    : CellOperation(threads, cell, std::move(store),
                    std::make_unique<Cs8Controller>(threads.operation, cell.deadlines, std::move(controller)),
                    std::move(instance_id), std::move(clocks)) {}

CellOperation::CellOperation(const Threads& threads, const Cell& cell, StoreQueue store,
                             std::unique_ptr<Controller> controller, std::string instance_id, Clocks clocks)
    : store_(std::move(store)),
      clocks_(std::move(clocks)),
      wake_(threads.operation),
      status_(clocks_, wake_, std::move(instance_id),
              {.describe = [this](Status& status) { describe_to(status); },
               .on_entered = [this](State state) { on_entered(state); },
               .store_fault = [this](const std::string& name,
                                     const std::string& message) { store_fault(name, message); }}),
      controller_(std::move(controller)),
      session_(cell, *controller_, status_, wake_, clocks_),
      location_(threads.operation, threads.computation, cell, store_, session_, status_, wake_, clocks_),
      plans_(threads.operation, threads.planning, location_.cell()),
      planning_(location_.cell(), location_.place(), store_, plans_, preparation_, status_, wake_),
      computation_(threads.computation, location_.regions(), status_,
                   std::make_unique<TimerAlarm>(threads.operation)),
      parking_(location_.cell(), computation_, preparation_, session_, status_),
      block_move_(location_.cell(), parking_, store_, status_, wake_),
      touches_(location_.cell(), computation_, store_, session_, preparation_, block_move_, status_, wake_,
               clocks_),
      manual_(location_.cell(), store_, preparation_, touches_, status_, wake_),
      way_back_(session_, status_, wake_),
      recovery_(location_.cell(), location_.place(), location_.regions(), store_, plans_, session_,
                preparation_, planning_, touches_, status_, clocks_),
      loop_{.executor = threads.operation, .ended = TimerWake(threads.operation)} {
  store_.tell_when_slow(status_, std::make_unique<TimerAlarm>(threads.operation));
  // What a hook throws would leave the link's loops, and with them the program.
  const auto guarded = [this](auto hook) {
    return [this, hook](const auto&... told) {
      try {
        hook(told...);
      } catch (const std::exception& error) {
        on_failed_hook(error.what());
      }
    };
  };
  controller_->listen(
      {.on_state = guarded([this](const cs8::State& state) { on_controller_state(state); }),
       .on_permit = guarded([this](const cs8::Permit& permit) { session_.on_permit(permit); }),
       .on_heartbeat = guarded([this] { session_.on_heartbeat(); }),
       .on_loss = guarded([this](const cs8::LinkError& error) { on_link_lost(error); })});
  if (const auto accepted = store_.store().last_accepted())
    status_.set_last_accepted(accepted->id, accepted->ended_at);
}

void CellOperation::launch() {
  if (auto restored = recovery_.restore()) {
    run_.emplace(*std::move(restored));
    touches_.begin_run(*run_);
    manual_.begin_run();
    set_logged_run(run_->run.id());
  }
  look_for_mounted_tool();
  look_for_block();
  if (run_) run_->block_is_away = block_is_away_;          // one that has no plan yet has not asked for it
  status_.enter(run_ ? State::kHeld : State::kResetting);  // finding the controller moves nothing
  loop_.runs = true;
  asio::co_spawn(loop_.executor, act_on_states(), [this](const std::exception_ptr& failure) {
    loop_.runs = false;
    loop_.ended.wake();
    if (failure) std::rethrow_exception(failure);
  });
}

void CellOperation::store_fault(const std::string& name, const std::string& message) {
  const auto run_id = run_ && run_->open ? std::optional(run_->run.id()) : std::nullopt;
  store_.append_fault({.run_id = run_id, .at = now_text(), .code = name, .message = message});
}

void CellOperation::describe_to(Status& status) {
  const bool open = run_ && run_->open;
  status.controller = session_.view(status.controller.probe);
  // Each line of the log names the run, and the touch under way or next.
  set_logged_run(open ? std::optional(run_->run.id()) : std::nullopt);
  set_logged_touch(open && run_->run.next() ? std::optional(run_->run.touches_done() + 1) : std::nullopt);
  status.touches_done = 0;
  status.touches_total = 0;
  status.identifiable_count.reset();
  status.condition_number.reset();
  status.predicted_tip_rms_m.reset();
  status.touch_benefit.reset();
  status.eta_s.reset();
  status.plane.reset();
  status.block_place.reset();
  if (run_) describe_run(status, *run_, cell().block, clocks_.steady());
  if (open) location_.leave();  // a run that begins ends the dialogue
  const auto guided = manual_.guide(status.state);
  const auto locating = location_.guide();
  status.by_hand = locating ? locating : guided;
}

std::vector<Unmet> CellOperation::unmet_preconditions() const {
  return unmet_by_controller(session_.connected(), session_.latest_state(), status_.fault());
}

std::vector<Unmet> CellOperation::unmet_before_start() const {
  std::vector<Unmet> unmet = unmet_whatever_is_given();
  if (auto one = unmet_by_temperature(cell(), {{}, clocks_.system()})) unmet.push_back(*std::move(one));
  return unmet;
}

std::vector<Unmet> CellOperation::unmet_whatever_is_given() const {
  std::vector<Unmet> unmet = unmet_preconditions();
  if (lost_place_ && !place()) unmet.push_back(*lost_place_);
  if (auto tool = unmet_by_tool()) unmet.push_back(*std::move(tool));
  if (auto unstored = unmet_by_unstored_end()) unmet.push_back(*std::move(unstored));
  return unmet;
}

std::optional<CommandRefusal> CellOperation::command(Command command, std::optional<std::int64_t> run_id) {
  if (run_id && (!run_ || run_->run.id() != *run_id)) {
    return CommandRefusal{.kind = CommandRefusal::Kind::kNotThisRun,
                          .detail = fmt::format("run {} is over", *run_id)};
  }
  const bool stops = command == Command::kStop || command == Command::kAbort;
  if (status_.is_ending() && !stops) return refusal_at_the_end();
  const State state = status_.state();
  const auto next = after(command);
  if (!next) {
    return CommandRefusal{
        .detail = fmt::format("{} is not possible in the state {}", command_name(command), state_name(state)),
        .code = FaultCode::kNotInThisState};
  }
  if (auto refusal = refusal_reason(command)) return refusal;
  if (command == Command::kLocate) return locate();
  if (command == Command::kTake) return take();
  if (command == Command::kUndo) return undo();
  spdlog::info("command {}", command_name(command));
  apply_command(command);
  if (status_.state() == state) status_.enter(*next);
  if (command == Command::kReset && *next == State::kResetting && !run_of_tool_) way_back_.ask();
  if (stops) loop_.ends_pass = false;  // it is the last word
  // Entering these two states stops the arm. A stop in any other case is sent all the same: nothing here
  // knows better than who gives it whether something moves.
  const bool is_sent = *next != state && (*next == State::kStopping || *next == State::kAborting);
  if (stops && !is_sent) session_.stop();
  return std::nullopt;
}

std::optional<CommandRefusal> CellOperation::take() {
  if (location_.awaits_touch()) return location_.take();
  if (auto why = manual_.take(active())) return CommandRefusal{.detail = *std::move(why)};
  return std::nullopt;
}

/// Why a command that the state allows is not taken all the same.
std::optional<CommandRefusal> CellOperation::refusal_reason(Command command) const {
  const bool goes_on = command == Command::kResume || command == Command::kRetry || command == Command::kSkip;
  if (goes_on && waits_for_its_files())
    return CommandRefusal{.detail = kept_words(run_->interruption->why_not)};
  switch (command) {
    case Command::kRetry:
    case Command::kSkip:
      return refuse_answer_to_hold(command);
    case Command::kConfirm:
      return refuse_confirm(status_.latest());
    case Command::kTouchTest:
      if (!run_of_tool_) return refuse_touch_test(status_.latest());
      if (!is_active(status_.state())) return std::nullopt;
      return CommandRefusal{.detail = "a run is active: mount the probe when it is over"};
    case Command::kTake:
      if (location_.awaits_touch() || manual_.takes_by_word(active_run())) return std::nullopt;
      return CommandRefusal{.detail =
                                manual_.awaits_touch()
                                    ? kNoTakeInRun
                                    : "no touch is awaited: touchcal locate and touchcal tool ask for some"};
    case Command::kUndo:
      return refuse_undo();
    case Command::kLocate:
      if (const auto tool = unmet_by_tool()) return CommandRefusal{.detail = tool->detail};
      if (!is_settling_) break;
      return CommandRefusal{.detail = "a touch of the last run is being stored; then once more"};
    case Command::kStart:
    case Command::kPause:
    case Command::kResume:
    case Command::kStop:
    case Command::kAbort:
    case Command::kClear:
    case Command::kReset:
    case Command::kAcknowledge:
      break;
  }
  return std::nullopt;
}

std::optional<CommandRefusal> CellOperation::refuse_answer_to_hold(Command command) const {
  const Command answer = touches_.answer_to_hold();
  if (status_.state() == State::kUnholding && answer != command)
    return CommandRefusal{.detail = fmt::format("{} was already given", command_name(answer))};
  if (status_.state() == State::kHeld && touches_.held_by() == HeldBy::kBlock)
    return CommandRefusal{
        .detail = "no touch holds this run: bring the block to the place that is named, then resume"};
  if (status_.state() == State::kHeld && touches_.held_by() == HeldBy::kNothing)
    return CommandRefusal{.detail = "no touch holds this run; resume goes on with the next one"};
  return std::nullopt;
}

std::optional<CommandRefusal> CellOperation::refuse_undo() const {
  const bool guiding =
      run_ && run_->guided && status_.state() == State::kExecute && run_->run.touches_done() > 0;
  if (auto refusal = location_.refusal_while_storing()) return refusal;
  if (location_.is_locating() ? location_.can_undo() : guiding) return std::nullopt;
  return CommandRefusal{.detail = "there is no touch by hand to take back"};
}

/// What a command changes that was not refused, before the next state is entered.
void CellOperation::apply_command(Command command) {
  const bool answers_hold =
      command == Command::kResume || command == Command::kRetry || command == Command::kSkip;
  // Why a run stands stays to be read until somebody answers it.
  const bool acknowledges = command == Command::kAcknowledge && !stands_still(status_.state());
  const bool told_of_block = status_.fault() && status_.fault()->code == FaultCode::kBlockToMove;
  const bool settles_fault =
      answers_hold || acknowledges || command == Command::kClear || command == Command::kReset;
  if (settles_fault && status_.fault()) {
    status_.clear_fault();
    status_.publish();
  }
  if (command == Command::kStop && location_.awaits_touch()) {
    location_.leave();
    status_.publish();
  }
  if (command == Command::kTouchTest && run_of_tool_) {
    run_of_tool_.reset();
    status_.publish();
  }
  if (status_.state() == State::kHeld && answers_hold) {
    if (touches_.held_by() == HeldBy::kBlock && !told_of_block) touches_.forget_hold();  // it is asked again
    touches_.settle_hold(*run_, command);
    status_.publish();
  }
}

std::optional<CommandRefusal> CellOperation::locate() {
  if (auto refusal = location_.locate()) return refusal;
  if (!location_.is_passing()) return std::nullopt;
  run_.reset();
  status_.forget_run();
  status_.enter(State::kStarting);
  return std::nullopt;
}

/// The last touch that a person made is forgotten and asked for again.
std::optional<CommandRefusal> CellOperation::undo() {
  spdlog::info("the last touch by hand is taken back");
  if (location_.is_locating()) {
    location_.undo();
  } else {
    manual_.undo(*run_);
  }
  return std::nullopt;
}

asio::awaitable<void> CellOperation::touch_stored() { return location_.stored(); }

/// Whether a run can start that touches by itself. What its recipe asks for is told when it is refused.
bool CellOperation::is_ready_to_start() const {
  const auto& fault = status_.fault();
  return unmet_before_start().empty() && (!fault || is_link_fault(fault->code));
}

/// What State says may be older than the answer of the command that was broken off: who takes the arm back
/// waits until none runs. In a dialogue by hand the arm is a person's.
bool CellOperation::is_way_back_due() const {
  const auto told = session_.latest_state();
  return told && (told->flags & cs8::kRetractDue) != 0 && !location_.is_locating();
}

/// The state machine's answer, but for an arm that is at a face or on its way back: what ends the motion
/// waits for its answer, and nobody else takes the arm.
std::optional<State> CellOperation::after(Command command) const {
  const State state = status_.state();
  if (way_back_.is_under_way()) {
    if (command == Command::kStop) return State::kStopping;
    if (command == Command::kAbort) return State::kAborting;
    if (command == Command::kLocate) return std::nullopt;
  }
  if (command == Command::kReset && state == State::kIdle && is_way_back_due()) return State::kResetting;
  return after_command(state, command);
}

std::vector<Command> CellOperation::exits() const {
  const State state = status_.state();
  std::vector<Command> commands = cell::exits(state);
  for (const Command command : {Command::kAbort, Command::kReset}) {
    const bool is_given = run_ || command != Command::kAbort;  // an abort names its run
    if (is_given && after(command) != after_command(state, command)) commands.push_back(command);
  }
  std::erase_if(commands, [this](Command command) {
    return !after(command) || refusal_reason(command) || (command == Command::kStart && !is_ready_to_start());
  });
  return commands;
}

void CellOperation::look_for_lost_place(const RunPage& last) {
  lost_place_ = unmet_by_lost_place(last, config_digest(), place().has_value());
}

void CellOperation::keep_place_in(const std::filesystem::path& file) {
  if (location_.keep_in(file)) forget_plans();
  look_for_lost_place(run_page(store_.store(), 1, {}));
  location_.keep_dialogue_in(file.parent_path() / kLocatingFile, recovery_.config_digest());
}

Status CellOperation::status() const {
  Status status = status_.latest();
  status.data_age_ms = data_age_ms();
  return status;
}

}  // namespace cell
