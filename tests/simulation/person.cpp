#include "tests/simulation/person.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "config/fault_file.hpp"
#include "sim_controller/fault_names.hpp"

namespace simulation {
namespace {

using namespace std::chrono_literals;
using cell::Command;
using cell::State;

/// Who has answered so many holds of one run ends it.
constexpr int kHoldsMax = 15;

bool is_acting(State state) {
  return state != State::kStopped && state != State::kIdle && state != State::kComplete &&
         state != State::kHeld && state != State::kAborted;
}

}  // namespace

void Person::act(const std::string& line) {
  journal_.note("person", line);
  controller_.inject(sim::planned(std::get<cell::DeclaredFault>(cell::parse_control_line(line))));
}

bool Person::mend_one(State state) {
  const cs8::State told = controller_.report();
  const auto lacks = [&told](cs8::StateFlag flag) { return (told.flags & flag) == 0; };
  const cs8::ProbeInputs probe = cs8::probe_inputs(told.flags);
  const auto fault = [](std::string_view name) { return fmt::format(R"({{"fault":"{}"}})", name); };
  if (told.emergency_stop == 2) return act(fault("release_emergency_stop")), true;
  if (told.emergency_stop == 1) return act(fault("acknowledge_emergency_stop")), true;
  if (told.task_error != 0) return act(fault("restart")), true;
  if ((told.flags & cs8::kHeld) != 0) return act(fault("move")), true;
  if (lacks(cs8::kArmCalibrated)) return act(fault("references_found")), true;
  if (told.monitor_speed_percent != 100) return act(R"({"fault":"monitor_speed","percent":100})"), true;
  if (lacks(cs8::kCellClosed)) return act(fault("close_cell")), true;
  if (told.mode != cs8::WorkingMode::kRemote) return act(fault("remote_mode")), true;
  // What does not stay on has its reason in the arm: a body that touches something.
  if (lacks(cs8::kPowered) && std::exchange(switched_on_, !switched_on_)) return act(fault("jog_home")), true;
  if (lacks(cs8::kPowered)) return act(fault("power_on")), true;
  switched_on_ = false;
  if (lacks(cs8::kSettled) && told.active_sequence == 0) return act(fault("settles")), true;
  if (probe.free()) {
    looked_at_stylus_ = false;
  } else if (lacks(cs8::kRetractDue)) {
    // The stylus and its cable, or a face that it stands at: what does not help is followed by the other.
    const bool looked = std::exchange(looked_at_stylus_, !looked_at_stylus_);
    return act(fault(looked ? "jog_home" : "probe_mended")), true;
  } else if (!cell::is_active(state)) {
    return act(fault("jog_home")), true;  // nothing takes it back from the face
  }
  return false;
}

void Person::command(cell::CellOperation& operation, Command command) {
  given_.push_back(command);
  const auto refusal = operation.command(command);
  journal_.note("person", fmt::format("commands {}{}", cell::command_name(command),
                                      refusal ? ": refused, " + refusal->detail : ""));
}

/// What a text says of the cell is done there.
void Person::act_by_words(std::string_view text) {
  const auto says = [text](std::string_view word) { return text.find(word) != std::string_view::npos; };
  if (says("stylus")) act(R"({"fault":"release_stylus"})");
  if (says("cable")) act(R"({"fault":"probe_mended"})");
  if (says("jog")) act(R"({"fault":"jog_home"})");
}

/// What the text names and the state takes, the first of it; without a text a run on hold goes on.
void Person::answer_by_words(cell::CellOperation& operation) {
  const auto exits = operation.exits();
  const auto fault = operation.status().fault;
  const std::string_view text = fault ? cell::describe(fault->code).next_step : "touchcal resume";
  act_by_words(text);
  for (const Command named : commands_named(text))
    if (std::ranges::find(exits, named) != exits.end()) return command(operation, named);
  command(operation, Command::kStop);
}

void Person::answer_hold(cell::CellOperation& operation) {
  const auto exits = operation.exits();
  const auto is_there = [&exits](Command one) { return std::ranges::find(exits, one) != exits.end(); };
  if (goes_by_words_ && ++holds_count_ < kHoldsMax) return answer_by_words(operation);
  act(R"({"fault":"probe_mended"})");  // he looks at the stylus whatever the reason
  const auto fault = operation.status().fault;
  if (fault && (fault->code == cell::FaultCode::kNoSafeWay || chance_.once_in(8)))
    act(R"({"fault":"jog_home"})");
  if (++holds_count_ > kHoldsMax) return command(operation, Command::kStop);
  if (is_there(Command::kSkip) && chance_.once_in(12)) return command(operation, Command::kSkip);
  if (is_there(Command::kRetry) && chance_.once_in(2)) return command(operation, Command::kRetry);
  command(operation, Command::kResume);
}

/// What the state asks for.
void Person::go_on(cell::CellOperation& operation) {
  const State state = operation.status().state;
  if (state == State::kHeld) return answer_hold(operation);
  const auto told = goes_by_words_ ? operation.status().fault : std::nullopt;
  if (told && state == State::kComplete && started_count_ < kRunsMax) return answer_by_words(operation);
  if (told) act_by_words(cell::describe(told->code).next_step);
  if (state == State::kAborted) {
    act(R"({"fault":"settles"})");  // he looks at the arm whatever the reason
    return command(operation, Command::kClear);
  }
  const bool wants_more = started_count_ < kRunsMax && state != State::kComplete;
  is_done_ = !wants_more && !is_acting(state);
  if (!wants_more) return;
  if (state == State::kStopped) return command(operation, Command::kReset);
  if (state != State::kIdle) return;
  holds_count_ = 0;
  const auto exits = operation.exits();
  if (std::ranges::find(exits, Command::kStart) != exits.end()) return start_();
  if (operation.status().fault) command(operation, Command::kAcknowledge);
}

void Person::look(cell::CellOperation& operation, Time now) {
  next_look_ = now + chance_.between(200ms, 900ms);
  const State state = operation.status().state;
  if (std::exchange(seen_, state) != state) answers_at_ = now + chance_.between(1s, 15s);
  const bool is_ready = operation.unmet_preconditions().empty() && !operation.status().waiting_for;
  if (is_ready && state != State::kHeld) {
    mends_at_.reset();
  } else if (!mends_at_) {
    mends_at_ = now + chance_.between(2s, 20s);
  } else if (*mends_at_ <= now && mend_one(state)) {
    mends_at_ = now + chance_.between(500ms, 3s);
    answers_at_ = now + chance_.between(3s, 8s);
  }
  if (is_acting(state) || *answers_at_ > now) return;
  answers_at_ = now + chance_.between(1s, 15s);
  go_on(operation);
}

std::vector<Command> commands_named(std::string_view text) {
  constexpr std::string_view kProgram = "touchcal ";
  std::vector<Command> named;
  for (std::size_t at = text.find(kProgram); at != std::string_view::npos; at = text.find(kProgram, at + 1)) {
    const std::string_view rest = text.substr(at + kProgram.size());
    for (const Command command : cell::kCommands)
      if (rest.starts_with(cell::command_name(command))) named.push_back(command);
  }
  return named;
}

}  // namespace simulation
