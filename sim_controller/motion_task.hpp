#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

/// The task of the controller's application that carries out one motion command at a time, a step each 4 ms:
/// PROTOCOL.md section 6, as the VAL3 application does it.
namespace sim {

using TimePoint = std::chrono::steady_clock::time_point;

/// How long the probe may take to seat again, and the arm to stand.
inline constexpr double kReseatSecondsMax = 0.5;
inline constexpr double kStandstillSecondsMax = 2.0;
/// VAL3's run-time error of an instruction that does not come to its end.
inline constexpr std::int32_t kTimeoutError = 60;

/// What the motion task is doing.
enum class Stage {
  kTravel,      // joint moves to the clear posture, or to a travel's target
  kApproach,    // joint move to where the search begins
  kReady,       // standing there: is the probe free?
  kSearch,      // the line, until the probe trips
  kTripped,     // braking after the trigger
  kBackOff,     // back along the line before the second touch
  kReseat,      // is the probe free again, for the second touch
  kRetract,     // back along the line and the approach
  kLastReseat,  // is it free at the end
  kBreakOff,    // braking to the end of the command
  kReturn,      // a stopped search goes back to its approach posture
};

cs8::Phase phase_of(Stage stage);

/// Where the probe tripped in a search.
struct Capture {
  cs8::CaptureSource source = cs8::CaptureSource::kNone;
  calib::JointVector contact = calib::JointVector::Zero();
  std::optional<calib::JointVector> stopped;  // once the arm rests
  double overtravel_m = 0.0;
  TimePoint at{};
};

/// A motion command that was taken and is not done.
struct RunningCommand {
  std::uint32_t sequence = 0;
  std::variant<cs8::Touch, cs8::Travel, cs8::Retract> order;
  TimePoint deadline{};
  Stage stage = Stage::kTravel;
  cs8::Outcome outcome = cs8::Outcome::kArrived;
  cs8::Phase broken_in = cs8::Phase::kIdle;  // idle when the command goes to its end
  std::int32_t error_number = 0;
  std::optional<Capture> first;  // when there are to be two
  std::optional<Capture> last;
  bool seated = false;  // the probe was free again on the way back: from there it is watched
  std::int32_t monitor_speed_percent = 100;  // the lowest in a search
  std::int32_t search_speed_um_s = 0;        // of the last search that began
  bool latch_armed = false;
  std::uint32_t edges = 0;  // of the latch input, since the trigger
  int stop_in_ticks = 0;    // from the trigger to the brakes
  int ticks_in_stage = 0;
  int unsettled_ticks = 0;  // at the end of a move, while the drives do not say that the arm stands
  bool returning = false;  // a stopped search has set out for its approach posture: the next stop is the last
  std::string collision;   // which body hit what
};

/// What the motion task remembers from one command to the next.
struct MotionTask {
  std::optional<RunningCommand> running;
  /// Back from a face to where the arm is clear of it, along what was travelled; the first stretch begins
  /// where the arm stands. While there is one and nothing runs, only Retract is taken.
  std::vector<Stretch> retract_path;
};

/// A command begins. Its fields were admitted.
RunningCommand begin_touch(const Plant& plant, Cabinet& cabinet, std::uint32_t sequence,
                           const cs8::Touch& order);
RunningCommand begin_travel(const Plant& plant, Cabinet& cabinet, std::uint32_t sequence,
                            const cs8::Travel& order);
RunningCommand begin_retract(const Plant& plant, Cabinet& cabinet, const std::vector<Stretch>& retract_path,
                             std::uint32_t sequence, const cs8::Retract& order);

/// Ends the running command early: brakes, and reports `outcome` at standstill; the first cause counts.
/// A search that is stopped (kStopped) goes back to its approach posture; stopped once more on that way, it
/// stands where it is.
void break_off(Cabinet& cabinet, RunningCommand& running, cs8::Outcome outcome,
               std::int32_t error_number = 0);

/// One tick, after the cabinet's. `at` is the tick's wall time. True when the command has ended.
bool step(const Plant& plant, Cabinet& cabinet, MotionTask& task, const CabinetTick& seen, TimePoint at);

}  // namespace sim
