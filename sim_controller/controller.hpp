#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/controller_state.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/plant.hpp"

/// The controller's side of the protocol as a step: what happened and when goes in, what is sent comes out.
/// The rules are those of cs8_protocol/PROTOCOL.md. No sockets, no clock; chance and time are handed in.
namespace sim {

/// Simulated seconds per wall second in which every motion takes no time: its result comes with the next
/// event.
inline constexpr double kSpeedMax = std::numeric_limits<double>::infinity();

/// Hosts may ask for a heartbeat timeout in this range; others get the nearest.
inline constexpr std::chrono::milliseconds kHeartbeatTimeoutMin{200};
inline constexpr std::chrono::milliseconds kHeartbeatTimeoutMax{2000};

struct ControllerOptions {
  std::uint64_t seed = 1;  // of all that differs from one touch to the next
  double speed = 1.0;      // simulated seconds per wall second; link times and deadlines are always wall time
  std::uint32_t session = 1;  // counts starts of the controller's application
  OperatorDuties duties;
  /// Longer only for a machine that stands still for seconds, as one on which many tests run.
  std::chrono::milliseconds heartbeat_timeout_max = kHeartbeatTimeoutMax;
};

/// A connection must say Hello within this time.
inline constexpr std::chrono::milliseconds kHelloTimeout{2000};
inline constexpr std::chrono::milliseconds kStatePeriod{20};

struct ConnectionOpened {};
struct ConnectionClosed {};
struct Tick {
  bool bytes_waiting = false;  // received but not read yet: the host is not silent
};
using Event = std::variant<ConnectionOpened, ConnectionClosed, Tick, cs8::Message>;

struct Replies {
  std::vector<cs8::Message> messages;
  bool close = false;                  // the connection, after the messages
  std::string warning;                 // for the log: a body hit something
  std::vector<LinkFault> link_faults;  // that are due, after the messages
};

ControllerState make_controller(const Plant& plant, const ControllerOptions& options, TimePoint now);

/// `now` never goes back from one step to the next.
Replies step(const Plant& plant, ControllerState& state, const Event& event, TimePoint now);

}  // namespace sim
