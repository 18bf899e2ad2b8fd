#include "sim_controller/probe.hpp"

#include <cmath>

namespace sim {
namespace {

/// Where in its tick a vibration pulse begins.
constexpr int kVibrationStep = kLatchStepsPerTick / 2;

bool is_tripped(const Probe& probe, bool deflected) {
  switch (probe.troubles.stylus) {
    case StylusTrouble::kNone:
      return deflected;
    case StylusTrouble::kStaysTouched:
      return true;
    case StylusTrouble::kNeverTouches:
      return false;
    case StylusTrouble::kSticks:
      return deflected || probe.tripped;
  }
  return deflected;
}

bool behind_wire(WireTrouble trouble, bool level) {
  return trouble == WireTrouble::kNone ? level : trouble == WireTrouble::kShorted;
}

ProbeInputs inputs_of(const ProbeTroubles& troubles, bool tripped) {
  return {behind_wire(troubles.contact_wire, tripped), behind_wire(troubles.loop_wire, !tripped)};
}

/// Nothing is under way, and every step of the tick will be as the last one was.
bool is_quiet(const Probe& probe, unsigned deflected) {
  if (deflected != 0U && deflected != kAllSteps) return false;
  return probe.bounce_steps == 0 && probe.vibration_steps == 0 && probe.troubles.vibration_s <= 0.0 &&
         is_tripped(probe, deflected != 0U) == probe.tripped &&
         inputs_of(probe.troubles, probe.tripped) == probe.inputs;
}

/// Whether the seat is open in this step, bounces and pulses with it.
bool is_open(Probe& probe, bool deflected) {
  const bool was_tripped = probe.tripped;
  probe.tripped = is_tripped(probe, deflected);
  if (!probe.tripped) probe.bounce_steps = 0;
  if (probe.tripped && !was_tripped) {
    probe.bounce_steps = 2 * probe.troubles.bounces;
    return true;
  }
  const bool bounced_off = probe.bounce_steps > 0 && probe.bounce_steps-- % 2 == 0;
  const bool shaken = probe.vibration_steps > 0 && probe.vibration_steps-- > 0;
  return shaken || (probe.tripped && !bounced_off);
}

}  // namespace

ProbeTick step(Probe& probe, unsigned deflected) {
  ProbeTick seen;
  if (is_quiet(probe, deflected)) return seen;
  for (int k = 0; k < kLatchStepsPerTick; ++k) {
    if (k == kVibrationStep && probe.troubles.vibration_s > 0.0) {
      probe.vibration_steps = static_cast<int>(std::floor(probe.troubles.vibration_s / kLatchSeconds + 1e-9));
      // Too short for the latch to see a level, and for anything that polls.
      if (probe.vibration_steps == 0 && !probe.inputs.contact &&
          probe.troubles.contact_wire == WireTrouble::kNone)
        ++seen.edges;
      probe.troubles.vibration_s = 0.0;
    }
    const bool was_high = probe.inputs.contact;
    probe.inputs = inputs_of(probe.troubles, is_open(probe, (deflected >> k & 1U) != 0U));
    if (was_high || !probe.inputs.contact) continue;
    ++seen.edges;
    if (!seen.edge_share && !probe.troubles.latch_loses_edges)
      seen.edge_share = static_cast<double>(k + 1) / kLatchStepsPerTick;
  }
  return seen;
}

void free_probe(Probe& probe) { probe.troubles.stylus = StylusTrouble::kNone; }

}  // namespace sim
