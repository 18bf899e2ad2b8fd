#include "sim_controller/trouble_effects.hpp"

namespace sim {
namespace {

/// Returns false when the trouble is not the probe's.
bool apply_to_probe(const Trouble& trouble, ProbeTroubles& probe) {
  switch (trouble.kind) {
    case TroubleKind::kStylusSticks:
      probe.stylus = StylusTrouble::kSticks;
      return true;
    case TroubleKind::kStylusStaysTouched:
      probe.stylus = StylusTrouble::kStaysTouched;
      return true;
    case TroubleKind::kStylusNeverTouches:
      probe.stylus = StylusTrouble::kNeverTouches;
      return true;
    case TroubleKind::kProbeBounces:
      probe.bounces = trouble.number;
      return true;
    case TroubleKind::kVibration:
      probe.vibration_s = trouble.seconds;
      return true;
    case TroubleKind::kLatchLost:
      probe.latch_loses_edges = true;
      return true;
    case TroubleKind::kContactCut:
      probe.contact_wire = WireTrouble::kCut;
      return true;
    case TroubleKind::kContactShort:
      probe.contact_wire = WireTrouble::kShorted;
      return true;
    case TroubleKind::kLoopCut:
      probe.loop_wire = WireTrouble::kCut;
      return true;
    case TroubleKind::kLoopShort:
      probe.loop_wire = WireTrouble::kShorted;
      return true;
    case TroubleKind::kProbeMended:
      probe = {};
      return true;
    case TroubleKind::kTaskDies:
    case TroubleKind::kOverruns:
    case TroubleKind::kMonitorSpeed:
    case TroubleKind::kReferencesLost:
    case TroubleKind::kReferencesFound:
    case TroubleKind::kMotionError:
    case TroubleKind::kCollision:
    case TroubleKind::kNeverSettles:
    case TroubleKind::kSettles:
    case TroubleKind::kRestarts:
    case TroubleKind::kConfirmsLate:
    case TroubleKind::kConfirmationKeyStuck:
      break;
  }
  return false;
}

void collide(ControllerState& state) {
  state.cabinet.panel.powered = false;
  if (!state.motion.running) return;
  break_off(state.cabinet, *state.motion.running, cs8::Outcome::kCollision);
  state.motion.running->collision = "following error";
}

}  // namespace

bool apply(const Trouble& trouble, Cabinet& cabinet) {
  if (apply_to_probe(trouble, cabinet.world.probe.troubles)) return true;
  switch (trouble.kind) {
    case TroubleKind::kMonitorSpeed:
      cabinet.panel.monitor_speed_percent = trouble.number;
      return true;
    case TroubleKind::kReferencesLost:
      cabinet.panel.arm_calibrated = false;
      return true;
    case TroubleKind::kReferencesFound:
      cabinet.panel.arm_calibrated = true;
      return true;
    case TroubleKind::kNeverSettles:
      cabinet.never_settles = true;
      return true;
    case TroubleKind::kSettles:
      cabinet.never_settles = false;
      return true;
    case TroubleKind::kConfirmationKeyStuck:
      cabinet.panel.confirm_key = cabinet.panel.confirm_key_stuck = true;
      return true;
    case TroubleKind::kTaskDies:
    case TroubleKind::kOverruns:
    case TroubleKind::kMotionError:
    case TroubleKind::kCollision:
    case TroubleKind::kRestarts:
    case TroubleKind::kConfirmsLate:
    case TroubleKind::kStylusSticks:
    case TroubleKind::kStylusStaysTouched:
    case TroubleKind::kStylusNeverTouches:
    case TroubleKind::kProbeBounces:
    case TroubleKind::kVibration:
    case TroubleKind::kLatchLost:
    case TroubleKind::kContactCut:
    case TroubleKind::kContactShort:
    case TroubleKind::kLoopCut:
    case TroubleKind::kLoopShort:
    case TroubleKind::kProbeMended:
      break;
  }
  return false;
}

void apply(const Trouble& trouble, ControllerState& state) {
  Cabinet& cabinet = state.cabinet;
  if (apply(trouble, cabinet)) return;
  switch (trouble.kind) {
    case TroubleKind::kTaskDies:
      cabinet.task_error = trouble.number;
      break;
    case TroubleKind::kOverruns:
      cabinet.overruns += static_cast<std::uint32_t>(trouble.number);
      break;
    case TroubleKind::kMotionError:
      if (state.motion.running) fail_motion(cabinet.drives, trouble.number);
      break;
    case TroubleKind::kCollision:
      collide(state);
      break;
    case TroubleKind::kRestarts:
      restart_application(state);
      break;
    case TroubleKind::kConfirmsLate:
      state.person.confirms_after_s = trouble.seconds;
      break;
    case TroubleKind::kMonitorSpeed:
    case TroubleKind::kReferencesLost:
    case TroubleKind::kReferencesFound:
    case TroubleKind::kNeverSettles:
    case TroubleKind::kSettles:
    case TroubleKind::kConfirmationKeyStuck:
    case TroubleKind::kStylusSticks:
    case TroubleKind::kStylusStaysTouched:
    case TroubleKind::kStylusNeverTouches:
    case TroubleKind::kProbeBounces:
    case TroubleKind::kVibration:
    case TroubleKind::kLatchLost:
    case TroubleKind::kContactCut:
    case TroubleKind::kContactShort:
    case TroubleKind::kLoopCut:
    case TroubleKind::kLoopShort:
    case TroubleKind::kProbeMended:
      break;  // the cabinet's
  }
}

}  // namespace sim
