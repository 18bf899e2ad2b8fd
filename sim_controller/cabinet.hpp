#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/drives.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/world.hpp"

namespace sim {

/// What people decide: the keys of pendant and cabinet, the door, the confirmation key at the cell.
struct Panel {
  bool powered = false;
  bool held = false;
  bool arm_calibrated = true;
  cs8::WorkingMode mode = cs8::WorkingMode::kRemote;
  std::int32_t mode_status = 0;
  std::int32_t emergency_stop = 0;
  std::int32_t monitor_speed_percent = 100;
  bool cell_closed = true;
  bool confirm_key = false;
  bool confirm_key_stuck = false;  // it does not go off any more
};

/// A motion of touchcal needs all of these, from its first tick to its last: remote mode is its own demand.
bool motion_permitted(const Panel& panel);

/// Whether a controller lets a program's motion go on, and how fast (manual 6, pages 101 and 102).
struct MotionLeave {
  bool permitted = false;
  bool is_slow = false;  // 250 mm/s: manual mode, and test mode but for its status "fast"
};
/// Of any program: in each mode whose status is "move" or "programmed". The door stops it in all but manual.
MotionLeave program_leave(const Panel& panel);

/// A level that a reader of the probe relies on has been there for so many ticks: 20 ms.
inline constexpr int kSteadyTicks = 5;

/// How far the hand touch test has come: free, touched, free again, each for kSteadyTicks.
enum class TouchTest { kNone, kFree, kTouched, kDone };

/// A person moves the arm with the pendant.
struct Jog {
  bool until_touch = true;  // he stops when the probe trips
};

/// A CS8 without its application: drives, inputs, panel, and the world they stand in. A value.
struct Cabinet {
  Panel panel;
  Drives drives;
  World world;
  std::mt19937_64 chance;
  int free_ticks = kSteadyTicks;  // how long both probe inputs have said so
  int touched_ticks = 0;
  int disagree_ticks = 0;
  TouchTest touch_test = TouchTest::kNone;
  std::optional<Jog> jog;  // under way
  bool jogged = false;     // by the operator, since the application last looked
  // What can be wrong with it, set by faults.
  std::int32_t task_error = 0;  // run-time error of a dead task of the application
  std::uint32_t overruns = 0;
  bool never_settles = false;

  [[nodiscard]] bool probe_free() const { return free_ticks >= kSteadyTicks; }
  [[nodiscard]] bool probe_touched() const { return touched_ticks >= kSteadyTicks; }
  [[nodiscard]] bool probe_disagrees() const { return disagree_ticks >= kSteadyTicks; }
  /// What the drives say, also between two moves of a command.
  [[nodiscard]] bool arm_stands() const { return is_settled(drives) && !never_settles; }
  [[nodiscard]] bool arm_rests() const { return is_empty(drives) && arm_stands(); }
};

Cabinet make_cabinet(const Plant& plant, std::uint64_t seed);

/// What one tick brought.
struct CabinetTick {
  TickMotion motion;
  Sensed sensed;
};

/// One tick of drives, probe and bodies. A collision takes the power and leaves the arm where it hit.
CabinetTick tick(const Plant& plant, Cabinet& cabinet, const MotionLeave& leave);
/// The same as touchcal's motions are permitted.
CabinetTick tick(const Plant& plant, Cabinet& cabinet);

/// `ticks` in which nothing moves and nobody does anything.
void rest(const Plant& plant, Cabinet& cabinet, std::int64_t ticks);

}  // namespace sim
