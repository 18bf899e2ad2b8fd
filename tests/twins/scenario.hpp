#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "config/fault_file.hpp"
#include "cs8_protocol/messages.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/operator.hpp"

/// What a host, people and chance do to a controller, as data. The same scenario drives both twins.
namespace twins {

// ---- steps of the host, each after the one before ----

struct Connect {  // where no connection stands
  bool says_hello = true;
};
struct Disconnect {};
struct Send {
  std::uint32_t sequence = 0;
  cs8::Payload payload;
};
/// The next message of that type that was not awaited yet. A connection that is closed, or the time, ends it
/// too.
struct Await {
  cs8::MessageType type{};
  double within_s = 1.0;  // simulated
};
/// The result of that command, or why there is none.
struct AwaitResult {
  std::uint32_t sequence = 0;
  double within_s = 60.0;
};
struct Wait {
  double seconds = 0.0;  // simulated
};
struct Heartbeats {
  bool on = true;
};
struct SecondClient {};  // another host connects
/// Something goes wrong or somebody acts, with the next tick.
struct Strike {
  sim::InjectedEvent what;
};
/// A person moves the arm with the pendant.
struct Jog {
  cell::JogOrder order;
};

// ---- what strikes when the cabinet is at a place, so that both twins are struck at the same one ----

enum class Moment {
  kMoveBegins,   // the arm leaves standstill
  kMoveEnds,     // it stands, settled or not
  kProbeTrips,   // rising edge of the latch input
  kLoopOpens,    // the other input
  kArmRests,     // settled, behind a motion
  kProbeIsFree,  // both inputs say so again
};
using Deed = std::variant<Send, Disconnect, Heartbeats, Strike>;
/// Counts from this step on. It does not hold up the host.
struct At {
  Moment moment{};
  int nth = 1;
  int ticks_after = 0;
  Deed deed;
};

using Step = std::variant<Connect, Disconnect, Send, Await, AwaitResult, Wait, Heartbeats, SecondClient,
                          Strike, Jog, At>;

struct Scenario {
  std::string name;
  std::vector<Step> steps;
  std::vector<sim::PlannedFault> faults;  // that count messages; of a message or a connection only
  std::uint64_t seed = 1;
  double confirms_after_s = 0.15;
  bool confirms = true;
  bool touch_tested = true;  // before the host comes
  bool powered = true;
};

}  // namespace twins
