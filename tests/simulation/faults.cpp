#include "tests/simulation/faults.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

namespace simulation {
namespace {

using namespace std::chrono_literals;

constexpr int kFaultsMax = 6;
/// A touch of the simulated cell takes about so long.
constexpr Time kTouchTime = 6s;
/// So many writes, or somewhat more, a daemon makes while it starts.
constexpr int kWritesOfStart = 1500;

/// The faults of config/FILES.md but for those that need another configuration to end (wrong_arm and the
/// like at every connection) and the key that is stuck for good.
constexpr std::array kLinesOfController{
    // a message, or what is done with it
    R"({"fault":"drop","on":"touch"})", R"({"fault":"drop","on":"touch_result"})",
    R"({"fault":"drop","on":"accepted"})", R"({"fault":"drop","on":"result_acknowledge"})",
    R"({"fault":"drop","on":"permit"})", R"({"fault":"drop","on":"begin"})",
    R"({"fault":"drop","on":"stop"})", R"({"fault":"drop","on":"result_query"})",
    R"({"fault":"drop","on":"move_result"})", R"({"fault":"drop","on":"welcome"})",
    R"({"fault":"duplicate","on":"touch"})", R"({"fault":"duplicate","on":"touch_result"})",
    R"({"fault":"duplicate","on":"permit"})", R"({"fault":"duplicate","on":"accepted"})",
    R"({"fault":"delay","on":"touch_result","ms":400})", R"({"fault":"delay","on":"touch_result","ms":3000})",
    R"({"fault":"delay","on":"accepted","ms":300})", R"({"fault":"delay","on":"touch","ms":500})",
    R"({"fault":"delay","on":"permit","ms":800})", R"({"fault":"wrong_sequence","on":"touch_result"})",
    R"({"fault":"wrong_sequence","on":"accepted"})", R"({"fault":"close","on":"touch"})",
    R"({"fault":"close","on":"touch_result"})", R"({"fault":"close","on":"accepted"})",
    R"({"fault":"close","on":"result_acknowledge"})", R"({"fault":"close_mid_frame","on":"touch_result"})",
    R"({"fault":"close_mid_frame","on":"state"})", R"({"fault":"byte_by_byte","on":"touch_result"})",
    R"({"fault":"merge","on":"touch_result"})", R"({"fault":"wrong_version","on":"state"})",
    R"({"fault":"unknown_type","on":"touch_result"})", R"({"fault":"bad_length","on":"touch_result"})",
    R"({"fault":"bad_value","on":"touch_result"})", R"({"fault":"wrong_session","on":"state"})",
    R"({"fault":"wrong_arm","on":"welcome"})", R"({"fault":"garbage"})",
    R"({"fault":"half_open","on":"touch_result"})", R"({"fault":"half_open","on":"touch"})",
    R"({"fault":"go_silent"})", R"({"fault":"stop_states","ms":1500})", R"({"fault":"refuse","ms":4000})",
    R"({"fault":"stale_result","on":"touch_result"})", R"({"fault":"wrong_joints","on":"touch_result"})",
    // the probe
    R"({"fault":"probe_stuck","touch":1,"phase":"search"})", R"({"fault":"probe_touched"})",
    R"({"fault":"probe_dead"})", R"({"fault":"probe_bounces","times":3})",
    R"({"fault":"vibration","touch":1,"phase":"travel","ms":1})",
    R"({"fault":"vibration","touch":1,"phase":"approach","ms":1})",
    R"({"fault":"vibration","touch":1,"phase":"search","ms":1})", R"({"fault":"latch_lost"})",
    R"({"fault":"contact_cut"})", R"({"fault":"contact_short"})", R"({"fault":"loop_cut"})",
    R"({"fault":"loop_short","touch":1,"phase":"retract"})",
    // the controller
    R"({"fault":"task_dies","error":20})", R"({"fault":"overruns","times":3})", R"({"fault":"restart"})",
    R"({"fault":"restart","touch":1,"phase":"search"})", R"({"fault":"monitor_speed","percent":50})",
    R"({"fault":"monitor_speed","touch":1,"phase":"search","percent":30})", R"({"fault":"references_lost"})",
    R"({"fault":"motion_error","touch":1,"phase":"travel","error":60})",
    R"({"fault":"collision","touch":1,"phase":"approach"})", R"({"fault":"never_settles"})",
    // people
    R"({"fault":"power_off"})", R"({"fault":"manual_mode"})", R"({"fault":"local_mode"})",
    R"({"fault":"open_cell"})", R"({"fault":"open_cell","touch":1,"phase":"search"})",
    R"({"fault":"touch_stylus"})", R"({"fault":"touch_stylus","touch":1,"phase":"retract"})",
    R"({"fault":"hold"})", R"({"fault":"hold","touch":1,"phase":"search"})", R"({"fault":"emergency_stop"})",
    R"({"fault":"emergency_stop","touch":1,"phase":"search"})",
    R"({"fault":"emergency_stop","touch":1,"phase":"retract"})", R"({"fault":"confirms_late","ms":20000})",
    R"({"fault":"confirms_late","ms":40000})", R"({"fault":"press_confirm"})", R"({"fault":"jog_home"})"};

constexpr std::array kCommands{cell::Command::kPause,     cell::Command::kResume, cell::Command::kStop,
                               cell::Command::kAbort,     cell::Command::kRetry,  cell::Command::kSkip,
                               cell::Command::kReset,     cell::Command::kClear,  cell::Command::kAcknowledge,
                               cell::Command::kTouchTest, cell::Command::kConfirm};

bool is_at_start(FaultKind kind) {
  return kind == FaultKind::kKilledAtStart || kind == FaultKind::kPowerFailsAtStart;
}

FaultKind draw_kind(Chance& chance) {
  constexpr int kOthers = static_cast<int>(FaultKind::kCommand);
  if (chance.below(100) < 45) return FaultKind::kController;
  return static_cast<FaultKind>(1 + chance.below(kOthers));
}

DrawnFault draw_fault(Chance& chance, Time at) {
  DrawnFault fault{.at = at, .kind = draw_kind(chance)};
  fault.number = 1 + chance.below(12);
  fault.lasts = chance.between(200ms, 6s);
  if (chance.once_in(5)) fault.lasts *= 10;
  if (fault.kind == FaultKind::kLinkHeldUp) fault.lasts /= 4;
  if (fault.kind == FaultKind::kClockJumps) fault.lasts = chance.between(-2h, 2h);
  if (is_at_start(fault.kind) && chance.once_in(2)) fault.number = 1 + chance.below(kWritesOfStart);
  if (is_at_start(fault.kind) && chance.once_in(4)) fault.at = Time{0};  // the first start makes the store
  if (fault.kind == FaultKind::kController)
    fault.line = kLinesOfController[static_cast<std::size_t>(chance.below(kLinesOfController.size()))];
  if (fault.kind == FaultKind::kCommand)
    fault.command = kCommands[static_cast<std::size_t>(chance.below(kCommands.size()))];
  return fault;
}

}  // namespace

std::string_view fault_kind_name(FaultKind kind) {
  switch (kind) {
    case FaultKind::kController:
      return "controller";
    case FaultKind::kLinkCut:
      return "link cut";
    case FaultKind::kLinkHalfOpen:
      return "link half open";
    case FaultKind::kLinkHeldUp:
      return "link held up";
    case FaultKind::kLinkInPieces:
      return "link in pieces";
    case FaultKind::kLinkRefuses:
      return "link refuses";
    case FaultKind::kLinkSwallows:
      return "link swallows";
    case FaultKind::kDiskFull:
      return "disk full";
    case FaultKind::kDiskWriteFails:
      return "disk write fails";
    case FaultKind::kDiskSyncFails:
      return "disk sync fails";
    case FaultKind::kDiskWritesShort:
      return "disk writes short";
    case FaultKind::kDiskStalls:
      return "disk stalls";
    case FaultKind::kClockJumps:
      return "clock jumps";
    case FaultKind::kKilled:
      return "killed";
    case FaultKind::kKilledAtWrite:
      return "killed at a write";
    case FaultKind::kPowerFails:
      return "power fails at a write";
    case FaultKind::kKilledAtStart:
      return "killed, and again at a write of the start";
    case FaultKind::kPowerFailsAtStart:
      return "killed, and power fails at a write of the start";
    case FaultKind::kTerminated:
      return "terminated";
    case FaultKind::kClientsFlood:
      return "clients come in crowds";
    case FaultKind::kClientRepeatsKey:
      return "a client repeats its key";
    case FaultKind::kClientsStopReading:
      return "clients do not read";
    case FaultKind::kCommand:
      return "command";
  }
  return "";
}

bool takes_power(FaultKind kind) {
  return kind == FaultKind::kPowerFails || kind == FaultKind::kPowerFailsAtStart;
}

DrawnFault of_controller(std::string line) {
  return {.kind = FaultKind::kController, .line = std::move(line)};
}

DrawnFault commanded(cell::Command command) { return {.kind = FaultKind::kCommand, .command = command}; }

std::string fault_text(const DrawnFault& fault) {
  const auto lasts_ms = std::chrono::duration_cast<std::chrono::milliseconds>(fault.lasts).count();
  if (fault.lasts == kUntilMended) return fmt::format("{}, until it is mended", fault_kind_name(fault.kind));
  switch (fault.kind) {
    case FaultKind::kController:
      return fault.line;
    case FaultKind::kCommand:
      return fmt::format("somebody commands {}", cell::command_name(fault.command));
    case FaultKind::kLinkCut:
    case FaultKind::kLinkHalfOpen:
    case FaultKind::kKilled:
    case FaultKind::kTerminated:
      return std::string(fault_kind_name(fault.kind));
    case FaultKind::kKilledAtWrite:
    case FaultKind::kPowerFails:
    case FaultKind::kKilledAtStart:
    case FaultKind::kPowerFailsAtStart:
    case FaultKind::kClientsFlood:
    case FaultKind::kClientsStopReading:
      return fmt::format("{} ({})", fault_kind_name(fault.kind), fault.number);
    case FaultKind::kLinkHeldUp:
    case FaultKind::kLinkInPieces:
    case FaultKind::kLinkRefuses:
    case FaultKind::kLinkSwallows:
    case FaultKind::kDiskFull:
    case FaultKind::kDiskWriteFails:
    case FaultKind::kDiskSyncFails:
    case FaultKind::kDiskWritesShort:
    case FaultKind::kDiskStalls:
    case FaultKind::kClockJumps:
    case FaultKind::kClientRepeatsKey:
      return fmt::format("{} ({} ms)", fault_kind_name(fault.kind), lasts_ms);
  }
  return "";
}

std::vector<DrawnFault> draw_faults(std::uint64_t seed, int touch_count) {
  Chance chance(seed * 2 + 1);
  std::vector<DrawnFault> faults;
  if (seed % 10 == 0) return faults;
  const int count = 1 + chance.below(kFaultsMax);
  for (int i = 0; i < count; ++i)
    faults.push_back(draw_fault(chance, chance.between(1s, 12s + touch_count * kTouchTime)));
  std::ranges::stable_sort(faults, {}, &DrawnFault::at);
  for (std::size_t i = 0; i < faults.size(); ++i) faults[i].event = i + 1;
  return faults;
}

std::vector<std::string> controller_lines() { return {kLinesOfController.begin(), kLinesOfController.end()}; }

}  // namespace simulation
