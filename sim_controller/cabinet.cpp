#include "sim_controller/cabinet.hpp"

#include <algorithm>

namespace sim {
namespace {

/// History of the inputs is not counted beyond this.
constexpr int kTicksMax = 1'000'000;

void count_inputs(Cabinet& cabinet) {
  const ProbeInputs& inputs = cabinet.world.probe.inputs;
  const auto count = [](int& ticks, bool on) { ticks = on ? std::min(ticks + 1, kTicksMax) : 0; };
  count(cabinet.free_ticks, inputs.free());
  count(cabinet.touched_ticks, inputs.touched());
  count(cabinet.disagree_ticks, !inputs.agree());
}

/// The test counts where a hand can be at the stylus: the arm without power, or in manual mode.
void watch_touch_test(Cabinet& cabinet) {
  const bool by_hand = !cabinet.panel.powered || cabinet.panel.mode == cs8::WorkingMode::kManual;
  switch (cabinet.touch_test) {
    case TouchTest::kNone:
      if (by_hand && cabinet.probe_free()) cabinet.touch_test = TouchTest::kFree;
      break;
    case TouchTest::kFree:
    case TouchTest::kTouched:
      if (!by_hand) {
        cabinet.touch_test = TouchTest::kNone;
      } else if (cabinet.touch_test == TouchTest::kFree && cabinet.probe_touched()) {
        cabinet.touch_test = TouchTest::kTouched;
      } else if (cabinet.touch_test == TouchTest::kTouched && cabinet.probe_free()) {
        cabinet.touch_test = TouchTest::kDone;
      }
      break;
    case TouchTest::kDone:
      break;
  }
  if (cabinet.probe_disagrees()) cabinet.touch_test = TouchTest::kNone;
}

/// Whether the pendant lets the arm move on.
bool jog_permitted(const Cabinet& cabinet) {
  const Panel& panel = cabinet.panel;
  return cabinet.jog && panel.mode == cs8::WorkingMode::kManual && panel.powered && !panel.held &&
         panel.emergency_stop == 0;
}

/// After each tick: a trip stops the jog, and one that has come to rest is over.
void watch_jog(Cabinet& cabinet, const Sensed& sensed) {
  if (!cabinet.jog) return;
  if (cabinet.jog->until_touch && sensed.edges > 0) reset_motion(cabinet.drives);
  if (!jog_permitted(cabinet) && !cabinet.drives.braking) reset_motion(cabinet.drives);
  if (is_empty(cabinet.drives) && is_settled(cabinet.drives)) cabinet.jog.reset();
}

bool may_move(const Panel& panel) {
  return panel.powered && !panel.held && panel.arm_calibrated && panel.emergency_stop == 0;
}

}  // namespace

bool motion_permitted(const Panel& panel) {
  return may_move(panel) && panel.mode == cs8::WorkingMode::kRemote && panel.cell_closed;
}

MotionLeave program_leave(const Panel& panel) {
  constexpr int kMoveStatus = 0, kFastTestStatus = 2;
  const bool is_manual = panel.mode == cs8::WorkingMode::kManual;
  const bool is_test = panel.mode == cs8::WorkingMode::kTest;
  const bool is_fast_test = is_test && panel.mode_status == kFastTestStatus;
  const bool moves =
      panel.mode != cs8::WorkingMode::kNone && (panel.mode_status == kMoveStatus || is_fast_test);
  return {.permitted = may_move(panel) && moves && (is_manual || panel.cell_closed),
          .is_slow = is_manual || (is_test && !is_fast_test)};
}

Cabinet make_cabinet(const Plant& plant, std::uint64_t seed) {
  Cabinet cabinet;
  cabinet.drives.joints = plant.start_joints;
  cabinet.world = make_world(plant);
  cabinet.chance.seed(seed);
  return cabinet;
}

CabinetTick tick(const Plant& plant, Cabinet& cabinet) {
  return tick(plant, cabinet, {.permitted = motion_permitted(cabinet.panel)});
}

CabinetTick tick(const Plant& plant, Cabinet& cabinet, const MotionLeave& leave) {
  CabinetTick seen;
  const bool permitted = cabinet.drives.braking || leave.permitted || jog_permitted(cabinet);
  seen.motion = tick(cabinet.drives, cabinet.panel.monitor_speed_percent, permitted, leave.is_slow);
  cabinet.world.powered = cabinet.panel.powered;
  seen.sensed = sense(plant, cabinet.world, seen.motion);
  if (seen.sensed.collision) {
    cabinet.panel.powered = false;
    displace(cabinet.drives, seen.motion.to);
  }
  watch_jog(cabinet, seen.sensed);
  count_inputs(cabinet);
  watch_touch_test(cabinet);
  return seen;
}

void rest(const Plant& plant, Cabinet& cabinet, std::int64_t ticks) {
  pass(plant, cabinet.world, static_cast<double>(ticks) * kTickSeconds);
  const int more = static_cast<int>(std::min<std::int64_t>(ticks, kTicksMax));
  for (int* history : {&cabinet.free_ticks, &cabinet.touched_ticks, &cabinet.disagree_ticks}) {
    if (*history > 0) *history = std::min(*history + more, kTicksMax);
  }
}

}  // namespace sim
