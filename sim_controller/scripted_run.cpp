#include "sim_controller/scripted_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <stdexcept>
#include <utility>

namespace sim {
namespace {

/// Numbers of a script and of a program are the same within this.
constexpr double kSameNumber = 1e-6;
/// The task of stop() has "~" and so much of the application's name (manual 6, page 79).
constexpr std::size_t kStopNameLength = 14;

}  // namespace

ScriptedRun::ScriptedRun(const Plant& plant, const val3::Application& application,
                         std::vector<ScriptStep> steps, std::uint64_t seed, std::chrono::sys_seconds date,
                         std::ostream& out)
    : plant_(plant),
      cabinet_(make_cabinet(plant, seed)),
      watch_([this](const std::string& text) { tell(text); }),
      links_(links_of(application, cards_of(steps))),
      steps_(std::move(steps)),
      system_(plant, cabinet_, options(date)),
      out_(out),
      application_(application) {}

Val3SystemOptions ScriptedRun::options(std::chrono::sys_seconds date) {
  Val3SystemOptions made;
  made.date = date;
  made.links = {};  // every input is the script's
  made.cards = cards_of(steps_);
  made.operator_owns_monitor_speed = false;
  made.log = [this](const std::string& text) { tell("log: " + text); };
  return made;
}

bool ScriptedRun::start(val3::Findings& findings) {
  const std::size_t before = findings.size();
  machine_.emplace(application_, system_, findings);
  if (findings.size() != before) return false;
  for (const std::string& link : links_.digital) system_.find_digital(link);
  for (const std::string& link : links_.analogue) system_.find_analogue(link);
  machine_->start();
  return true;
}

void ScriptedRun::step() {
  for (; next_ < steps_.size() && steps_[next_].at_s <= seconds() + kTickSeconds / 2.0; ++next_)
    carry_out(steps_[next_]);
  machine_->tick();
  watch_.look_at_power(cabinet_.panel, "by the program");
  watch_.look_at_program(*machine_, system_, is_ending());
  const CabinetTick seen = system_.tick();
  watch_.look_at_cell(seen, cabinet_, system_);
  tick(plant_, person_, cabinet_);
  ++ticks_;
  if (!machine_->ended()) return;
  tell("the application has ended");
  is_over_ = true;
}

bool ScriptedRun::is_ending() const {
  return machine_->ended() || machine_->task_status("~" + application_.name.substr(0, kStopNameLength)) != -1;
}

bool ScriptedRun::is_busy() const {
  const Drives& drives = cabinet_.drives;
  return !person_.plan.empty() || !sim::is_empty(drives) || !sim::is_settled(drives);
}

double ScriptedRun::seconds() const { return static_cast<double>(ticks_) * kTickSeconds; }

void ScriptedRun::tell(const std::string& text) {
  out_ << fmt::format("{:9.3f}  {}\n", seconds(), text) << std::flush;
}

void ScriptedRun::refuse(const ScriptStep& step, const std::string& why) {
  watch_.fail(fmt::format("line {}: {}: {}", step.line, step.act.name, why));
}

void ScriptedRun::carry_out(const ScriptStep& step) {
  const ScriptAct& act = step.act;
  switch (act.kind) {
    case ScriptAct::Kind::kInput:
      if (!system_.signals().set(act.name, act.on)) refuse(step, "no input of that name can be set");
      break;
    case ScriptAct::Kind::kAnalogue:
      if (!system_.signals().set(act.name, act.number)) refuse(step, "no input of that name can be set");
      break;
    case ScriptAct::Kind::kConnect:
    case ScriptAct::Kind::kDisconnect:
    case ScriptAct::Kind::kSend:
    case ScriptAct::Kind::kExpectSent:
      at_channel(step);
      break;
    case ScriptAct::Kind::kExpectOutput:
    case ScriptAct::Kind::kExpectNumber:
    case ScriptAct::Kind::kExpectTask:
      expect(step);
      break;
    case ScriptAct::Kind::kKey:
      system_.page().press(static_cast<int>(act.number));
      system_.page().release(static_cast<int>(act.number));
      break;
    case ScriptAct::Kind::kPage:
      show_page();
      break;
    case ScriptAct::Kind::kStop:
      machine_->stop();
      break;
    case ScriptAct::Kind::kSocket:
    case ScriptAct::Kind::kCard:
      break;  // is there since before the start
    case ScriptAct::Kind::kEnd:
      is_over_ = true;
      break;
    default:
      at_panel(act);
      watch_.look_at_power(cabinet_.panel, fmt::format("line {} of the script", step.line));
  }
}

void ScriptedRun::at_panel(const ScriptAct& act) {
  Panel& panel = cabinet_.panel;
  switch (act.kind) {
    case ScriptAct::Kind::kPower:
      return perform(plant_, cabinet_, act.on ? Act::kPowerOn : Act::kPowerOff);
    case ScriptAct::Kind::kHold:
      return perform(plant_, cabinet_, act.on ? Act::kHold : Act::kMove);
    case ScriptAct::Kind::kEmergency:
      if (act.number == 2.0) return perform(plant_, cabinet_, Act::kEmergencyStop);
      perform(plant_, cabinet_, Act::kReleaseEmergencyStop);
      if (act.number == 0.0) perform(plant_, cabinet_, Act::kAcknowledgeEmergencyStop);
      return;
    case ScriptAct::Kind::kMode: {
      const auto mode = static_cast<cs8::WorkingMode>(static_cast<int>(act.number));
      panel.powered = panel.powered && panel.mode == mode;
      panel.mode = mode;
      return;
    }
    case ScriptAct::Kind::kSpeed:
      panel.monitor_speed_percent = static_cast<std::int32_t>(std::clamp(act.number, 0.0, 100.0));
      return;
    default:
      return;
  }
}

/// The script's own peer at a socket.
void ScriptedRun::at_channel(const ScriptStep& step) {
  const ScriptAct& act = step.act;
  const auto id = system_.channels().find(act.name);
  if (!id) return refuse(step, "there is no such socket");
  Val3Channel& channel = system_.channels().at(*id);
  if (act.kind == ScriptAct::Kind::kConnect) {
    if (!channel.accept()) refuse(step, "somebody is connected, or the application does not listen");
    return;
  }
  if (act.kind == ScriptAct::Kind::kDisconnect) return channel.leave();
  if (act.kind == ScriptAct::Kind::kSend) {
    const std::vector<std::uint8_t> bytes(act.text.begin(), act.text.end());
    if (channel.peer() != Val3Channel::Peer::kConnected || channel.give(bytes) != bytes.size())
      refuse(step, "not connected, or the application does not read; connect it first");
    return;
  }
  const std::vector<std::uint8_t> bytes = channel.take();
  const std::string sent(bytes.begin(), bytes.end());
  if (sent != act.text) refuse(step, fmt::format("sent {:?}", sent));
}

void ScriptedRun::expect(const ScriptStep& step) {
  const ScriptAct& act = step.act;
  if (act.kind == ScriptAct::Kind::kExpectTask) {
    const int status = machine_->task_status(act.name);
    if (status != static_cast<int>(act.number)) refuse(step, fmt::format("the task's status is {}", status));
    return;
  }
  if (act.kind == ScriptAct::Kind::kExpectOutput) {
    const auto id = system_.signals().known_digital(act.name);
    const bool is_on = id && system_.digital(*id);
    if (is_on != act.on) refuse(step, is_on ? "it is on" : "it is off");
    return;
  }
  const auto value = number_of(act.name);
  if (!value) return refuse(step, "the application has no such num or bool");
  if (!(std::abs(*value - act.number) <= kSameNumber)) refuse(step, fmt::format("it is {}", *value));
}

/// "n", "n[3]"; a bool is 0 or 1.
std::optional<double> ScriptedRun::number_of(const std::string& place) const {
  std::string name = place;
  std::size_t index = 0;
  if (const std::size_t open = place.find('['); open != std::string::npos) {
    name = place.substr(0, open);
    index = std::strtoul(place.c_str() + open + 1, nullptr, 10);
  }
  const int global = application_.global_named(name);
  if (global < 0) return std::nullopt;
  try {
    const val3::Kind kind = application_.globals[static_cast<std::size_t>(global)].declared.type.kind;
    if (kind == val3::Kind::kBool) return machine_->truth(name, index) ? 1.0 : 0.0;
    if (kind == val3::Kind::kNum) return machine_->number(name, index);
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
  return std::nullopt;
}

void ScriptedRun::show_page() {
  tell("page: " + system_.page().title());
  std::string lines = system_.page().text();
  lines.erase(lines.find_last_not_of('\n') + 1);
  if (!lines.empty()) out_ << lines << '\n';
  for (const auto& [name, text] : system_.page().elements()) out_ << name << " = " << text << '\n';
}

int ScriptedRun::summary() {
  show_page();
  for (const val3::TaskView& task : machine_->tasks())
    tell(fmt::format("task {}: status {}, at {}:{}, {} overruns, at most {} lines between two waits",
                     task.name, task.status, task.file, task.line, task.overruns,
                     machine_->most_lines(task.name)));
  const int failures = watch_.conclude(cabinet_);
  tell(fmt::format("{} lines of program; {} failures", machine_->lines(), failures));
  return failures;
}

}  // namespace sim
