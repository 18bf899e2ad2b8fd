#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/joint_vector.hpp"
#include "cs8_protocol/messages.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/timeline.hpp"
#include "sim_controller/world.hpp"

/// The controller's side of the protocol as a step: what happened and when goes in, what is sent comes out.
/// The rules are those of cs8_protocol/PROTOCOL.md. No sockets, no clock; chance and time are handed in.
namespace sim {

using TimePoint = std::chrono::steady_clock::time_point;

/// Simulated seconds per wall second in which every motion takes no time: its result comes with the next
/// event.
inline constexpr double kSpeedMax = std::numeric_limits<double>::infinity();

struct ControllerOptions {
  std::uint64_t seed = 1;  // of the touch noise, the only chance there is
  double speed = 1.0;      // simulated seconds per wall second; link times and deadlines are always wall time
  std::uint32_t session = 1;  // counts starts of the controller's application
};

/// What the operator and the cabinet decide. The operator script built in: remote mode and no hold from the
/// start; power comes kPowerUpSeconds (simulated) later. A collision takes power away, and an edge in a
/// travel leaves the stylus on something with no known way back: when a host says Hello the next time, the
/// operator has jogged the arm to its start posture, and powers up as at the start.
struct Panel {
  bool powered = false;
  bool held = false;
  bool arm_calibrated = true;
  cs8::WorkingMode mode = cs8::WorkingMode::kRemote;
  std::int32_t mode_status = 0;
  std::int32_t emergency_stop = 0;
  std::int32_t monitor_speed_percent = 100;
};

inline constexpr double kPowerUpSeconds = 0.2;

/// A motion command that was taken and is not done.
struct RunningCommand {
  std::uint32_t sequence = 0;
  cs8::MessageType type{};  // kTouch, kTravel or kRetract
  std::int32_t search_speed_um_s = 0;
  double approach_speed_m_s = 0.0;
  Timeline timeline;
  TimePoint started;  // of the timeline
  TimePoint deadline;
};

struct ControllerState {
  std::mt19937_64 chance;
  double speed = 1.0;
  std::uint32_t session = 1;
  Panel panel;
  std::optional<TimePoint> power_due;
  bool operator_called = false;  // to free the arm by hand, at the next Hello
  calib::JointVector joints;     // where the arm stands, or stood when the running command began
  std::vector<Stretch>
      way_out;  // back from a face; while there is one, only a Retract is taken and goes along it
  std::optional<RunningCommand> running;
  std::uint32_t last_sequence = 0;
  std::optional<cs8::Message> stored_result;  // until acknowledged
  // The connection, if any.
  bool connected = false;
  bool greeted = false;
  std::chrono::milliseconds heartbeat_timeout{};
  TimePoint last_heard;
  TimePoint next_state;
  std::uint32_t state_counter = 0;
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
  bool close = false;   // the connection, after the messages
  std::string warning;  // for the log: a body hit something
};

ControllerState make_controller(const Plant& plant, const ControllerOptions& options, TimePoint now);

/// `now` never goes back from one step to the next.
Replies step(const Plant& plant, ControllerState& state, const Event& event, TimePoint now);

}  // namespace sim
