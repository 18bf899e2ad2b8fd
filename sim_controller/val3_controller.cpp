#include "sim_controller/val3_controller.hpp"

#include <algorithm>
#include <utility>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/trouble_effects.hpp"

namespace sim {
namespace {

/// An application has answered a message and begun what it asks for within this time.
constexpr double kWorkSeconds = 0.5;
/// stop() and what it waits for take no longer.
constexpr int kStopTicksMax = static_cast<int>(2.0 / kTickSeconds);

/// How often it is looked whether a task has failed, for the log.
constexpr int kTaskWatchTicks = 25;

bool has_flag(const std::optional<cs8::State>& state, cs8::StateFlag flag) {
  return state && (state->flags & flag) != 0;
}

}  // namespace

Val3Controller::Val3Controller(Plant plant, const val3::Application& application,
                               Val3ControllerOptions options, val3::Findings& findings)
    : plant_(std::move(plant)),
      plants_(std::move(options.plants)),
      cabinet_(make_cabinet(plant_, options.seed)),
      person_{.duties = options.duties},
      plan_(std::move(options.faults)),
      system_(plant_, cabinet_, [&] {
        options.system.log = [this](const std::string& message) { messages_.push_back(message); };
        return std::move(options.system);
      }()) {
  sim::start(person_);
  machine_ = std::make_unique<val3::Machine>(application, system_, findings);
  machine_->start();
}

Val3Controller::Brought Val3Controller::tick() {
  Brought brought;
  apply_due_faults(brought);
  sim::tick(plant_, person_, cabinet_);
  const CabinetTick seen = system_.tick();
  if (seen.sensed.collision) {
    if (!operator_called_) brought.told.push_back("collision: " + *seen.sensed.collision + "; power is off");
    operator_called_ = true;
  }
  cabinet_.jogged = false;  // an application sees it by where the arm stands
  machine_->tick();
  if (++ticks_ % kTaskWatchTicks == 0) watch_tasks(brought);
  take_messages(brought);
  return brought;
}

Val3Channel* Val3Controller::host_channel() {
  Val3Channels& channels = system_.channels();
  for (int id = 0; id < channels.count(); ++id) {
    Val3Channel& channel = channels.at(id);
    if (channel.is_active() && !channel.is_client()) return &channel;
  }
  return nullptr;
}

// ---- what the people see on the wire ----

void Val3Controller::note_received(const cs8::Message& message) {
  switch (cs8::type_of(message)) {
    case cs8::MessageType::kHeartbeat:
      return;
    case cs8::MessageType::kHello:
      if (operator_called_) called_to_free_arm(person_);
      operator_called_ = false;
      break;
    case cs8::MessageType::kTouch:
      touch_sequence_ = message.sequence;
      break;
    default:
      break;
  }
  busy_until_s_ = clock_s() + kWorkSeconds;
}

void Val3Controller::note_sent(const cs8::Message& message) {
  if (const auto* state = std::get_if<cs8::State>(&message.payload)) {
    state_ = *state;
  } else if (const auto* permit = std::get_if<cs8::Permit>(&message.payload)) {
    const bool wants_test = permit->reason == cs8::PermitReason::kRefused &&
                            permit->detail == static_cast<std::int32_t>(cs8::RejectReason::kTouchTestMissing);
    if (permit->state == cs8::PermitState::kAwaited) asked_to_confirm(person_);
    if (wants_test) asked_for_touch_test(person_);
  } else if (const auto* touched = std::get_if<cs8::TouchResult>(&message.payload)) {
    note_result(touched->outcome);
  } else if (const auto* moved = std::get_if<cs8::MoveResult>(&message.payload)) {
    note_result(moved->outcome);
  }
}

/// With a deflected stylus and no way back of its own the arm stays where it is until somebody frees it.
void Val3Controller::note_result(cs8::Outcome outcome) {
  if (outcome == cs8::Outcome::kUnexpectedContact && !has_flag(state_, cs8::kRetractDue) &&
      !cabinet_.probe_free())
    operator_called_ = true;
}

bool Val3Controller::is_busy() const {
  const Drives& drives = cabinet_.drives;
  return !person_.plan.empty() || plan_.waits() || !sim::is_empty(drives) || !sim::is_settled(drives) ||
         (state_ && state_->active_sequence != 0) || clock_s() < busy_until_s_;
}

cs8::State Val3Controller::report() const {
  cs8::State report = state_.value_or(cs8::State{});
  // A report that is late is of no use to who looks at the cell itself.
  const Panel& panel = cabinet_.panel;
  const auto flag = [&report](cs8::StateFlag bit, bool on) {
    report.flags = on ? report.flags | bit : report.flags & ~static_cast<std::uint32_t>(bit);
  };
  flag(cs8::kPowered, panel.powered);
  flag(cs8::kHeld, panel.held);
  flag(cs8::kArmCalibrated, panel.arm_calibrated);
  flag(cs8::kSettled, cabinet_.arm_stands());
  flag(cs8::kQueueEmpty, sim::is_empty(cabinet_.drives));
  flag(cs8::kProbeTouched, cabinet_.world.probe.inputs.contact);
  flag(cs8::kProbeLoopClosed, cabinet_.world.probe.inputs.loop);
  flag(cs8::kCellClosed, panel.cell_closed);
  report.mode = panel.mode;
  report.emergency_stop = panel.emergency_stop;
  report.monitor_speed_percent = panel.monitor_speed_percent;
  report.joints = wire_from_joints(cabinet_.drives.joints);
  return report;
}

// ---- what goes wrong ----

void Val3Controller::apply_due_faults(Brought& brought) {
  const bool is_touch = state_ && state_->active_sequence != 0 && state_->active_sequence == touch_sequence_;
  plan_.on_touch_phase(is_touch ? touch_sequence_ : 0, is_touch ? state_->phase : cs8::Phase::kIdle);
  for (const InjectedEvent& due : plan_.advance(kTickSeconds)) {
    if (const auto* of_link = std::get_if<LinkFault>(&due)) {
      brought.link_faults.push_back(*of_link);
    } else if (const auto* act = std::get_if<Act>(&due)) {
      const bool runs = (state_ && state_->active_sequence != 0) || !sim::is_empty(cabinet_.drives);
      if (*act == Act::kJogHome && runs) perform(plant_, cabinet_, Act::kManualMode);
      perform(plant_, cabinet_, *act);
    } else if (const Trouble& trouble = std::get<Trouble>(due); !apply(trouble, cabinet_)) {
      apply_to_application(trouble, brought);
    }
  }
}

void Val3Controller::apply_to_application(const Trouble& trouble, Brought& brought) {
  switch (trouble.kind) {
    case TroubleKind::kTaskDies:
      fail_a_task(trouble.number);
      break;
    case TroubleKind::kMotionError:
      fail_motion(cabinet_.drives, trouble.number);
      break;
    case TroubleKind::kCollision:
      cabinet_.panel.powered = false;
      operator_called_ = true;
      break;
    case TroubleKind::kRestarts:
      restart();
      break;
    case TroubleKind::kConfirmsLate:
      person_.confirms_after_s = trouble.seconds;
      break;
    default:
      brought.told.emplace_back("a fault that a VAL3 application cannot have was left out");
      break;
  }
}

/// The newest of those that run; killed at the pendant, say.
void Val3Controller::fail_a_task(int error) {
  const std::vector<val3::TaskView> tasks = machine_->tasks();
  const auto task =
      std::find_if(tasks.rbegin(), tasks.rend(), [](const val3::TaskView& view) { return view.status == 1; });
  if (task != tasks.rend()) machine_->fail_task(task->name, error);
}

/// At the pendant: stop() runs while the others live; then the application is started anew.
void Val3Controller::restart() {
  machine_->stop();
  for (int i = 0; i < kStopTicksMax && !machine_->ended(); ++i) {
    system_.tick();
    machine_->tick();
  }
  system_.end_application();
  failed_tasks_.clear();
  state_.reset();
  machine_->start();
}

void Val3Controller::watch_tasks(Brought& brought) {
  for (const val3::TaskView& task : machine_->tasks()) {
    if (task.status <= 1 || !failed_tasks_.insert(task.name).second) continue;
    brought.told.push_back("task " + task.name + " stopped with error " + std::to_string(task.status) +
                           " at " + task.file + ":" + std::to_string(task.line) +
                           (task.error.empty() ? "" : ": " + task.error));
  }
}

void Val3Controller::take_messages(Brought& brought) {
  for (std::string& message : std::exchange(messages_, {})) brought.told.push_back(std::move(message));
}

}  // namespace sim
