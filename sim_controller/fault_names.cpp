#include "sim_controller/fault_names.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "config/config_error.hpp"
#include "cs8_protocol/names.hpp"

namespace sim {
namespace {

/// The one figure that a fault has beside its trigger.
enum class Figure { kNone, kTime, kTimeOrNone, kError, kPercent, kTimes };

struct Entry {
  std::string_view name;
  std::variant<Fault, TroubleKind, Act> what;
  Figure figure = Figure::kNone;
};

constexpr std::array kTable{
    // the link
    Entry{"close", Fault::kCloseSocket},
    Entry{"half_open", Fault::kHalfOpen},
    Entry{"go_silent", Fault::kGoSilent},
    Entry{"stop_states", Fault::kStopStates, Figure::kTimeOrNone},
    Entry{"garbage", Fault::kGarbage},
    Entry{"refuse", Fault::kRefuse, Figure::kTime},
    Entry{"drop", Fault::kDrop},
    Entry{"duplicate", Fault::kDuplicate},
    Entry{"delay", Fault::kDelay, Figure::kTime},
    Entry{"wrong_sequence", Fault::kWrongSequence},
    Entry{"close_mid_frame", Fault::kCloseMidFrame},
    Entry{"byte_by_byte", Fault::kByteByByte},
    Entry{"merge", Fault::kMerge},
    Entry{"wrong_version", Fault::kWrongVersion},
    Entry{"unknown_type", Fault::kUnknownType},
    Entry{"bad_length", Fault::kBadLength},
    Entry{"bad_value", Fault::kBadValue},
    Entry{"wrong_session", Fault::kWrongSession},
    Entry{"wrong_arm", Fault::kWrongArm},
    Entry{"wrong_application", Fault::kWrongApplication},
    Entry{"wrong_limits", Fault::kWrongLimits},
    Entry{"stale_result", Fault::kStaleResult},
    Entry{"wrong_joints", Fault::kWrongJoints},
    // the probe
    Entry{"probe_stuck", TroubleKind::kStylusSticks},
    Entry{"probe_touched", TroubleKind::kStylusStaysTouched},
    Entry{"probe_dead", TroubleKind::kStylusNeverTouches},
    Entry{"probe_bounces", TroubleKind::kProbeBounces, Figure::kTimes},
    Entry{"vibration", TroubleKind::kVibration, Figure::kTime},
    Entry{"latch_lost", TroubleKind::kLatchLost},
    Entry{"contact_cut", TroubleKind::kContactCut},
    Entry{"contact_short", TroubleKind::kContactShort},
    Entry{"loop_cut", TroubleKind::kLoopCut},
    Entry{"loop_short", TroubleKind::kLoopShort},
    Entry{"probe_mended", TroubleKind::kProbeMended},
    // the controller
    Entry{"task_dies", TroubleKind::kTaskDies, Figure::kError},
    Entry{"overruns", TroubleKind::kOverruns, Figure::kTimes},
    Entry{"restart", TroubleKind::kRestarts},
    Entry{"monitor_speed", TroubleKind::kMonitorSpeed, Figure::kPercent},
    Entry{"references_lost", TroubleKind::kReferencesLost},
    Entry{"references_found", TroubleKind::kReferencesFound},
    Entry{"motion_error", TroubleKind::kMotionError, Figure::kError},
    Entry{"collision", TroubleKind::kCollision},
    Entry{"never_settles", TroubleKind::kNeverSettles},
    Entry{"settles", TroubleKind::kSettles},
    // people
    Entry{"power_on", Act::kPowerOn},
    Entry{"power_off", Act::kPowerOff},
    Entry{"manual_mode", Act::kManualMode},
    Entry{"local_mode", Act::kLocalMode},
    Entry{"remote_mode", Act::kRemoteMode},
    Entry{"open_cell", Act::kOpenCell},
    Entry{"close_cell", Act::kCloseCell},
    Entry{"touch_stylus", Act::kTouchStylus},
    Entry{"release_stylus", Act::kReleaseStylus},
    Entry{"press_confirm", Act::kPressConfirm},
    Entry{"release_confirm", Act::kReleaseConfirm},
    Entry{"hold", Act::kHold},
    Entry{"move", Act::kMove},
    Entry{"emergency_stop", Act::kEmergencyStop},
    Entry{"release_emergency_stop", Act::kReleaseEmergencyStop},
    Entry{"acknowledge_emergency_stop", Act::kAcknowledgeEmergencyStop},
    Entry{"jog_home", Act::kJogHome},
    Entry{"confirms_late", TroubleKind::kConfirmsLate, Figure::kTime},
    Entry{"confirmation_key_stuck", TroubleKind::kConfirmationKeyStuck},
};

const Entry& entry_of(const cell::DeclaredFault& declared) {
  const auto found = std::ranges::find(kTable, declared.fault, &Entry::name);
  if (found == kTable.end()) {
    declared.fail(
        "fault", "there is no fault " + cell::in_quotes(declared.fault) + "; config/FILES.md lists them all");
  }
  return *found;
}

/// The value whose name it is; nothing when there is none.
template <class Value>
std::optional<Value> named(std::string_view wanted) {
  for (int number = 0; number < 256; ++number) {
    const auto value = static_cast<Value>(number);
    if (!cs8::name(value).empty() && cs8::name(value) == wanted) return value;
  }
  return std::nullopt;
}

void demand(const cell::DeclaredFault& declared, const char* key, bool given, bool wanted) {
  if (given && !wanted) {
    declared.fail(key, "the fault " + cell::in_quotes(declared.fault) + " has no use for it; remove it");
  }
  if (wanted && !given) {
    declared.fail("", "the fault " + cell::in_quotes(declared.fault) + " wants \"" + key + "\"; add it");
  }
}

void demand_figure(const cell::DeclaredFault& declared, Figure figure) {
  const bool time = figure == Figure::kTime || (figure == Figure::kTimeOrNone && declared.duration_s);
  demand(declared, "ms", declared.duration_s.has_value(), time);
  demand(declared, "error", declared.error.has_value(), figure == Figure::kError);
  demand(declared, "percent", declared.percent.has_value(), figure == Figure::kPercent);
  demand(declared, "times", declared.times.has_value(), figure == Figure::kTimes);
}

cs8::MessageType message_type(const cell::DeclaredFault& declared) {
  const auto type = named<cs8::MessageType>(*declared.on);
  if (!type) {
    declared.fail("on", "there is no message " + cell::in_quotes(*declared.on) +
                            "; cs8_protocol/PROTOCOL.md lists them, and there is \"connection\"");
  }
  return *type;
}

Trigger trigger_of(const cell::DeclaredFault& declared) {
  if (declared.touch) {
    if (!declared.phase) return AtTouch{};
    const auto phase = named<cs8::Phase>(*declared.phase);
    if (!phase || *phase == cs8::Phase::kIdle) {
      declared.fail("phase",
                    "is " + cell::in_quotes(*declared.phase) + "; give travel, approach, search or retract");
    }
    return AtTouch{*phase};
  }
  if (!declared.on) return AtOnce{};
  if (*declared.on == "connection") return AtConnection{};
  return message_type(declared);
}

/// A fault in a message needs the message it is in, and comes with it.
void demand_message(const cell::DeclaredFault& declared, Fault fault, const Trigger& on) {
  const FaultTarget target = target_of(fault);
  const auto* type = std::get_if<cs8::MessageType>(&on);
  if (target == FaultTarget::kConnection) return;
  if (type == nullptr) {
    declared.fail(declared.on ? "on" : "", "the fault " + cell::in_quotes(declared.fault) +
                                               " is one of a message; give the message's name as \"on\"");
  }
  if (!fits(target, *type)) {
    declared.fail("on", "the fault " + cell::in_quotes(declared.fault) + " cannot be put into " +
                            cell::in_quotes(*declared.on));
  }
  demand(declared, "after_ms", declared.after_s.has_value(), false);
}

}  // namespace

PlannedFault planned(const cell::DeclaredFault& declared) {
  const Entry& entry = entry_of(declared);
  demand_figure(declared, entry.figure);
  const double seconds = declared.duration_s.value_or(0.0);
  const int number = declared.error.value_or(declared.percent.value_or(declared.times.value_or(0)));
  const Trigger on = trigger_of(declared);
  const auto occurrence = declared.touch ? *declared.touch : declared.count.value_or(cell::Occurrence{});
  PlannedFault fault{.what = Trouble{},
                     .on = on,
                     .nth = static_cast<std::uint32_t>(occurrence.nth),
                     .every = occurrence.every,
                     .after_s = declared.after_s.value_or(0.0)};
  if (const auto* of_link = std::get_if<Fault>(&entry.what)) {
    demand_message(declared, *of_link, on);
    fault.what = LinkFault{*of_link, seconds};
  } else if (const auto* act = std::get_if<Act>(&entry.what)) {
    fault.what = *act;
  } else {
    fault.what = Trouble{std::get<TroubleKind>(entry.what), number, seconds};
  }
  return fault;
}

std::vector<PlannedFault> planned(const std::vector<cell::DeclaredFault>& declared) {
  std::vector<PlannedFault> faults;
  faults.reserve(declared.size());
  for (const cell::DeclaredFault& fault : declared) faults.push_back(planned(fault));
  return faults;
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kTable) names.emplace_back(entry.name);
  return names;
}

}  // namespace sim
