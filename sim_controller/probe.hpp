#pragma once

#include <optional>

#include "cs8_protocol/messages.hpp"

namespace sim {

/// Resolution of the latch: levels and edges are known in steps of this length.
inline constexpr double kLatchSeconds = 0.0002;

using cs8::ProbeInputs;

enum class StylusTrouble {
  kNone,
  kStaysTouched,  // reads touched, whatever the stylus does
  kNeverTouches,  // the stylus gives way without a trip
  kSticks,        // once tripped it does not seat again
};

enum class WireTrouble {
  kNone,
  kCut,      // the input reads 0: of the contact, never touched; of the loop, open
  kShorted,  // the input reads 1: of the contact, always touched; of the loop, always closed
};

/// Injected troubles; what the fault plan sets, and free_probe() takes away.
struct ProbeTroubles {
  StylusTrouble stylus = StylusTrouble::kNone;
  WireTrouble contact_wire = WireTrouble::kNone;
  WireTrouble loop_wire = WireTrouble::kNone;
  int bounces = 0;                 // each trip opens and closes again so often, a latch step each
  double vibration_s = 0.0;        // above 0: one pulse of this length, in the middle of the next tick
  bool latch_loses_edges = false;  // the input is seen when it is polled, but captures nothing
};

/// The probe from the stylus to the inputs.
struct Probe {
  ProbeTroubles troubles;
  ProbeInputs inputs;       // now
  bool tripped = false;     // the seat is open, by the material or by a trouble; bounces and pulses aside
  int bounce_steps = 0;     // left
  int vibration_steps = 0;  // left
};

/// What the inputs did in one tick.
struct ProbeTick {
  int edges = 0;                     // rising edges on the latch input, however short
  std::optional<double> edge_share;  // share of the tick of the first that the latch captured
};

/// The latch captures a rising edge when the input was low for 0.2 ms before and stays high for 0.2 ms.
inline constexpr int kLatchStepsPerTick = 20;
/// Every step of a tick, as bits.
inline constexpr unsigned kAllSteps = (1U << kLatchStepsPerTick) - 1U;

/// One tick. Bit k of `deflected`: the material holds the stylus off its seat in latch step k, which ends at
/// share (k + 1) / 20.
ProbeTick step(Probe& probe, unsigned deflected);

/// Somebody frees the probe by hand: its stylus troubles are over. Wires, bounces and the latch stay as they
/// are.
void free_probe(Probe& probe);

}  // namespace sim
