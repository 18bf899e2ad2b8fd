#include "tests/simulation/table_modes.hpp"

#include <spdlog/fmt/fmt.h>

namespace simulation {
namespace {

using namespace std::chrono_literals;
using cell::Command;
using Modes = std::vector<TableMode>;

DrawnFault fault_named(std::string_view name, std::string_view more = "") {
  return of_controller(fmt::format(R"({{"fault":"{}"{}}})", name, more));
}
DrawnFault fault_at(std::string_view name, std::string_view message, std::string_view more = "") {
  return of_controller(fmt::format(R"({{"fault":"{}","on":"{}"{}}})", name, message, more));
}
DrawnFault lasting(FaultKind kind) { return {.kind = kind, .lasts = kUntilMended}; }

Modes modes_of_messages() {
  constexpr auto kNeeds = Needs::kMessage;
  return {
      {"message", "the command is lost", {fault_at("drop", "touch")}, kNeeds, "P23"},
      {"message", "the command comes twice", {fault_at("duplicate", "touch")}, kNeeds, "P36"},
      {"message", "the command is half a second late", {fault_at("delay", "touch", R"(,"ms":500)")}, kNeeds},
      {"message", "the link ends at the command", {fault_at("close", "touch")}, kNeeds, "P22"},
      {"message", "the acceptance is lost", {fault_at("drop", "accepted")}, kNeeds},
      {"message",
       "the acceptance has another number",
       {fault_at("wrong_sequence", "accepted")},
       kNeeds,
       "P36"},
      {"message", "the answer is lost", {fault_at("drop", "touch_result")}, kNeeds, "P23"},
      {"message", "the answer comes twice", {fault_at("duplicate", "touch_result")}, kNeeds, "P36"},
      {"message",
       "the answer is three seconds late",
       {fault_at("delay", "touch_result", R"(,"ms":3000)")},
       kNeeds,
       "P23"},
      {"message",
       "the answer has another number",
       {fault_at("wrong_sequence", "touch_result")},
       kNeeds,
       "P36"},
      {"message",
       "the link ends in the middle of the answer",
       {fault_at("close_mid_frame", "touch_result")},
       kNeeds,
       "P22"},
      {"message", "the answer comes byte by byte", {fault_at("byte_by_byte", "touch_result")}, kNeeds},
      {"message", "the answer is glued to the next message", {fault_at("merge", "touch_result")}, kNeeds},
      {"message",
       "the answer is of an unknown type",
       {fault_at("unknown_type", "touch_result")},
       kNeeds,
       "P36"},
      {"message", "the answer has a wrong length", {fault_at("bad_length", "touch_result")}, kNeeds, "P36"},
      {"message",
       "the answer has an outcome that is none",
       {fault_at("bad_value", "touch_result")},
       kNeeds,
       "P37"},
      {"message",
       "the answer is that of the touch before",
       {fault_at("stale_result", "touch_result")},
       kNeeds,
       "P35"},
      {"message",
       "the answer has joints of elsewhere",
       {fault_at("wrong_joints", "touch_result")},
       kNeeds,
       "P37"},
      {"message", "the acknowledgement is lost", {fault_at("drop", "result_acknowledge")}, kNeeds},
      {"message",
       "the link ends at the acknowledgement",
       {fault_at("close", "result_acknowledge")},
       kNeeds,
       "P22"},
      {"message", "the wish for a permit is lost", {fault_at("drop", "begin")}, kNeeds},
      {"message", "the permit is lost", {fault_at("drop", "permit")}, kNeeds},
      {"message", "the answer to a move is lost", {fault_at("drop", "move_result")}, kNeeds, "P23"},
  };
}

Modes modes_of_link() {
  return {
      {"link", "cut", {{.kind = FaultKind::kLinkCut}}, {}, "P22"},
      {"link", "the cable is pulled for a while", {{.kind = FaultKind::kLinkHalfOpen}}, {}, "P22"},
      {"link", "held up for three seconds", {{.kind = FaultKind::kLinkHeldUp, .lasts = 3s}}, {}, "P22"},
      {"link", "held up for a tenth of a second", {{.kind = FaultKind::kLinkHeldUp, .lasts = 100ms}}},
      {"link",
       "in pieces of three bytes",
       {{.kind = FaultKind::kLinkInPieces, .number = 3, .lasts = kUntilMended}}},
      {"link",
       "cut, and nobody listens",
       {lasting(FaultKind::kLinkRefuses), {.kind = FaultKind::kLinkCut}},
       {},
       "P22"},
      {"link",
       "cut, and nobody answers",
       {lasting(FaultKind::kLinkSwallows), {.kind = FaultKind::kLinkCut}},
       {},
       "P22"},
      {"link", "the controller sends what is no frame", {fault_named("garbage")}, {}, "P36"},
      {"link", "the controller works and sends nothing", {fault_named("go_silent")}, {}, "P22"},
      {"link", "the controller sends no state for 1.5 s", {fault_named("stop_states", R"(,"ms":1500)")}},
      {"link", "a state of another version", {fault_at("wrong_version", "state")}, {}, "P36"},
      {"link", "a state of another session", {fault_at("wrong_session", "state")}, {}, "P36"},
      {"link",
       "cut, and another arm answers",
       {fault_at("wrong_arm", "welcome"), {.kind = FaultKind::kLinkCut}}},
      {"link",
       "cut, and another application answers",
       {fault_at("wrong_application", "welcome"), {.kind = FaultKind::kLinkCut}}},
  };
}

Modes modes_of_probe() {
  return {
      {"probe", "does not seat after a trip", {fault_named("probe_stuck")}, {}, "P25 P26"},
      {"probe", "reads touched", {fault_named("probe_touched")}, {}, "P01 P12 P13"},
      {"probe", "never trips", {fault_named("probe_dead")}, {}, "P02 P10"},
      {"probe", "bounces", {fault_named("probe_bounces", R"(,"times":3)")}, {}, "P14"},
      {"probe", "one pulse of 1 ms", {fault_named("vibration", R"(,"ms":1)")}, {}, "P11 P12 P15"},
      {"probe", "trips are not latched", {fault_named("latch_lost")}, {}, "P16"},
      {"probe", "contact wire cut", {fault_named("contact_cut")}, {}, "P02 P26"},
      {"probe", "contact wire shorted", {fault_named("contact_short")}, {}, "P01 P26"},
      {"probe", "loop wire cut", {fault_named("loop_cut")}, {}, "P26"},
      {"probe", "loop wire shorted", {fault_named("loop_short")}, {}, "P26"},
  };
}

Modes modes_of_controller() {
  return {
      {"controller", "a task dies", {fault_named("task_dies", R"(,"error":20)")}},
      {"controller", "periods are missed", {fault_named("overruns", R"(,"times":3)")}, {}, "P24"},
      {"controller", "the application is restarted", {fault_named("restart")}, {}, "P22"},
      {"controller", "monitor speed 50 %", {fault_named("monitor_speed", R"(,"percent":50)")}, {}, "P19"},
      {"controller", "joint zeros lost", {fault_named("references_lost")}, {}, "P03"},
      {"controller",
       "a motion cannot be carried out",
       {fault_named("motion_error", R"(,"error":60)")},
       Needs::kMotionCommand},
      {"controller", "collision", {fault_named("collision")}, Needs::kMotionCommand},
      {"controller", "the arm is never said to stand", {fault_named("never_settles")}, {}, "P18"},
  };
}

Modes modes_of_people() {
  return {
      {"people", "power off", {fault_named("power_off")}, {}, "P03 P20"},
      {"people", "manual mode", {fault_named("manual_mode")}, {}, "P03 P20"},
      {"people", "local mode", {fault_named("local_mode")}, {}, "P03 P20"},
      {"people", "the cell is opened", {fault_named("open_cell")}, {}, "P20"},
      {"people", "a hand on the stylus", {fault_named("touch_stylus")}, {}, "P01 P11 P13"},
      {"people", "hold at the pendant", {fault_named("hold")}, {}, "P03 P20"},
      {"people", "emergency stop", {fault_named("emergency_stop")}, {}, "P03 P20"},
      {"people", "the arm is jogged away", {fault_named("jog_home")}, {}, "P30"},
      {"people", "the next confirmation comes too late", {fault_named("confirms_late", R"(,"ms":40000)")}},
      {"people", "the key is pressed unasked", {fault_named("press_confirm")}},
  };
}

Modes modes_of_machine() {
  return {
      {"disk", "full", {lasting(FaultKind::kDiskFull)}, {}, "P39"},
      {"disk", "writes fail", {lasting(FaultKind::kDiskWriteFails)}, {}, "P39"},
      {"disk", "syncs fail", {lasting(FaultKind::kDiskSyncFails)}, {}, "P39"},
      {"disk", "writes are short", {lasting(FaultKind::kDiskWritesShort)}, {}, "P39"},
      {"disk", "stalls", {lasting(FaultKind::kDiskStalls)}, {}, "P39"},
      {"daemon", "killed", {{.kind = FaultKind::kKilled}}, {}, "P41"},
      {"daemon",
       "killed at its next write",
       {{.kind = FaultKind::kKilledAtWrite, .number = 1}},
       Needs::kWrite,
       "P41"},
      {"daemon",
       "power fails at its next write",
       {{.kind = FaultKind::kPowerFails, .number = 1}},
       Needs::kWrite,
       "P41"},
      {"daemon",
       "killed, and again as it starts",
       {{.kind = FaultKind::kKilledAtStart, .number = 1}},
       {},
       "P41"},
      {"daemon", "told to end (SIGTERM)", {{.kind = FaultKind::kTerminated}}, {}, "P41"},
      {"daemon",
       "the clock of the day jumps back by an hour",
       {{.kind = FaultKind::kClockJumps, .lasts = -1h}}},
      {"daemon",
       "the clock of the day jumps ahead by an hour",
       {{.kind = FaultKind::kClockJumps, .lasts = 1h}}},
  };
}

Modes modes_of_clients() {
  return {
      {"clients", "stop", {commanded(Command::kStop)}, {}, "P21 P40"},
      {"clients", "abort", {commanded(Command::kAbort)}, {}, "P40"},
      {"clients", "pause", {commanded(Command::kPause)}, {}, "P40"},
      {"clients", "resume", {commanded(Command::kResume)}, {}, "P40"},
      {"clients", "retry", {commanded(Command::kRetry)}, {}, "P40"},
      {"clients", "skip", {commanded(Command::kSkip)}, {}, "P38 P40"},
      {"clients", "reset", {commanded(Command::kReset)}, {}, "P40"},
      {"clients", "clear", {commanded(Command::kClear)}, {}, "P40"},
      {"clients", "acknowledge", {commanded(Command::kAcknowledge)}, {}, "P40"},
      {"clients", "start", {commanded(Command::kStart)}, {}, "P08"},
      {"clients",
       "pause and resume at once",
       {commanded(Command::kPause), commanded(Command::kResume)},
       {},
       "P40"},
      {"clients",
       "stop and reset at once",
       {commanded(Command::kStop), commanded(Command::kReset)},
       {},
       "P40"},
      {"clients",
       "abort and stop at once",
       {commanded(Command::kAbort), commanded(Command::kStop)},
       {},
       "P40"},
      {"clients", "a hundred requests at once", {{.kind = FaultKind::kClientsFlood, .number = 10}}},
      {"clients", "five that do not read", {{.kind = FaultKind::kClientsStopReading, .number = 5}}},
  };
}

}  // namespace

std::span<const TableMode> table_modes() {
  static const Modes modes = [] {
    Modes all{{"nothing", "nothing goes wrong", {}}};
    for (const Modes& more : {modes_of_messages(), modes_of_link(), modes_of_probe(), modes_of_controller(),
                              modes_of_people(), modes_of_machine(), modes_of_clients()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return modes;
}

std::string_view message_of(const TableMode& mode) {
  constexpr std::string_view kOn = R"("on":")";
  const std::string_view text = mode.faults.front().line;
  const std::size_t begin = text.find(kOn) + kOn.size();
  return text.substr(begin, text.find('"', begin) - begin);
}

std::string_view reason_of(Needs needs) {
  switch (needs) {
    case Needs::kNothing:
      return "";
    case Needs::kMessage:
      return "its message is not among the next two on the wire";
    case Needs::kMotionCommand:
      return "no motion command is with the controller";
    case Needs::kWrite:
      return "the daemon writes nothing before the next two messages";
  }
  return "";
}

}  // namespace simulation
