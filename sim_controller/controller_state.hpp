#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"
#include "sim_controller/fault_plan.hpp"
#include "sim_controller/motion_task.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/permit.hpp"

namespace sim {

/// All that a controller remembers from one step to the next (controller.hpp).
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
  std::chrono::milliseconds heartbeat_timeout_max{};
  TimePoint last_heard;
  TimePoint next_state;
  std::uint32_t state_counter = 0;
  FaultPlan plan;  // what is to go wrong; it stays over restarts
};

/// The application is restarted, in a new session: arm, probe and people stay as they are; what it
/// remembered is gone.
void restart_application(ControllerState& state);

}  // namespace sim
