#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/motion_task.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/permit.hpp"
#include "sim_controller/plant.hpp"

/// The controller's side of the protocol as a step: what happened and when goes in, what is sent comes out.
/// The rules are those of cs8_protocol/PROTOCOL.md. No sockets, no clock; chance and time are handed in.
namespace sim {

/// Simulated seconds per wall second in which every motion takes no time: its result comes with the next
/// event.
inline constexpr double kSpeedMax = std::numeric_limits<double>::infinity();

struct ControllerOptions {
  std::uint64_t seed = 1;  // of all that differs from one touch to the next
  double speed = 1.0;      // simulated seconds per wall second; link times and deadlines are always wall time
  std::uint32_t session = 1;  // counts starts of the controller's application
  OperatorDuties duties;
};

struct ControllerState {
  double speed = 1.0;
  TimePoint next_tick{};  // wall time
  Cabinet cabinet;
  Operator person;
  bool operator_called = false;  // to free the arm by hand, at the next Hello
  // The application.
  std::uint32_t session = 1;
  MotionTask motion;
  PermitHolder permit;
  std::uint32_t last_sequence = 0;
  std::optional<cs8::Message> stored_result;  // until acknowledged
  // The connection, if any.
  bool connected = false;
  bool greeted = false;
  std::chrono::milliseconds heartbeat_timeout{};
  TimePoint last_heard;
  TimePoint next_state;
  std::uint32_t state_counter = 0;
  FaultPlan plan;  // what is to go wrong; it stays over restarts
};

/// Hosts may ask for a heartbeat timeout in this range; others get the nearest.
inline constexpr std::chrono::milliseconds kHeartbeatTimeoutMin{200};
inline constexpr std::chrono::milliseconds kHeartbeatTimeoutMax{2000};
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

/// The application is restarted, in a new session: arm, probe and people stay as they are; what it
/// remembered is gone.
void restart_application(ControllerState& state);

}  // namespace sim
