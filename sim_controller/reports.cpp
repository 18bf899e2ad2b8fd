#include "sim_controller/reports.hpp"

#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/contact.hpp"

namespace sim {
namespace {

constexpr std::uint32_t kApplicationVersion = 100;  // 0.1.0
constexpr std::uint32_t kLanguageVersion = 70702;   // s7.7.2

std::uint32_t clock_ms(TimePoint now) {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count());
}

std::int32_t error_number(const RunningCommand& command, const Ending& ending) {
  return ending.outcome == cs8::Outcome::kMotionError ? command.timeline.error_number : 0;
}

}  // namespace

cs8::Welcome welcome(const Plant& plant, const ControllerState& state, std::uint32_t open_sequence,
                     TimePoint now) {
  cs8::Welcome message;
  message.application = cs8::text16("touchcal");
  message.arm = cs8::text16(plant.arm_name);
  message.application_version = kApplicationVersion;
  message.language_version = kLanguageVersion;
  message.session = state.session;
  message.last_sequence = state.last_sequence;
  message.open_sequence = open_sequence;
  message.heartbeat_timeout_ms = static_cast<std::uint32_t>(state.heartbeat_timeout.count());
  message.clock_ms = clock_ms(now);
  message.lower_limits = wire_from_joints(plant.joint_ranges.lower);
  message.upper_limits = wire_from_joints(plant.joint_ranges.upper);
  message.search_length_max_dmm = cs8::dmm_from_metres(kSearchLengthMaxMetres);
  message.search_speed_max_um_s = search_speed_max_um_s(plant);
  return message;
}

cs8::State state_report(const Plant& plant, const ControllerState& state, const Place& place, TimePoint now) {
  const Panel& panel = state.panel;
  cs8::State report;
  report.session = state.session;
  report.clock_ms = clock_ms(now);
  const auto flag = [&report](cs8::StateFlag bit, bool on) { report.flags |= on ? bit : 0u; };
  flag(cs8::kPowered, panel.powered);
  flag(cs8::kHeld, panel.held);
  flag(cs8::kArmCalibrated, panel.arm_calibrated);
  flag(cs8::kSettled, !state.running);
  flag(cs8::kQueueEmpty, !state.running);
  flag(cs8::kProbeTouched, trip_gap_m(plant, place.joints, 0.0) <= 0.0);
  flag(cs8::kRetractDue, !state.way_out.empty());
  report.mode = panel.mode;
  report.mode_status = panel.mode_status;
  report.emergency_stop = panel.emergency_stop;
  report.monitor_speed_percent = panel.monitor_speed_percent;
  report.joints = wire_from_joints(place.joints);
  report.active_sequence = state.running ? state.running->sequence : 0;
  report.phase = place.phase;
  return report;
}

cs8::TouchResult touch_result(const ControllerState& state, const RunningCommand& command,
                              const Ending& ending) {
  cs8::TouchResult result;
  result.outcome = ending.outcome;
  result.phase = ending.phase;
  result.source = ending.capture ? cs8::CaptureSource::kLatched : cs8::CaptureSource::kNone;
  result.stopped = wire_from_joints(state.joints);
  if (const auto& capture = ending.capture) {
    result.contact = wire_from_joints(capture->contact);
    result.stopped = wire_from_joints(capture->stopped);
    result.overtravel_dmm = cs8::dmm_from_metres(capture->overtravel_m);
    const std::chrono::duration<double> wall(capture->at_s / state.speed);
    result.contact_clock_ms =
        clock_ms(command.started + std::chrono::duration_cast<TimePoint::duration>(wall));
  }
  result.search_speed_um_s = command.search_speed_um_s;
  result.monitor_speed_percent = state.panel.monitor_speed_percent;
  result.error_number = error_number(command, ending);
  return result;
}

cs8::MoveResult move_result(const ControllerState& state, const RunningCommand& command,
                            const Ending& ending) {
  return {ending.outcome, ending.phase, wire_from_joints(state.joints), error_number(command, ending)};
}

}  // namespace sim
