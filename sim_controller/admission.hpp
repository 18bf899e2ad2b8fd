#pragma once

#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "cs8_protocol/messages.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// What is wrong with a command in itself, whatever the controller does at the moment: its fields, its
/// postures, its search. Nothing when it may be carried out.
std::optional<cs8::Rejected> refusal(const Plant& plant, const cs8::Touch& command);
std::optional<cs8::Rejected> refusal(const Plant& plant, const cs8::Travel& command);
std::optional<cs8::Rejected> refusal(const Plant& plant, const cs8::Retract& command);

/// The fastest search the controller takes, in wire units.
std::int32_t search_speed_max_um_s(const Plant& plant);

calib::JointVector joints_from_wire(const cs8::JointsMicrodeg& joints);
cs8::JointsMicrodeg wire_from_joints(const calib::JointVector& joints);

struct TouchMotion {
  std::vector<calib::JointVector> waypoints;  // the last is the clear posture
  calib::JointVector approach;
  calib::JointVector search_end;
  double travel_speed_m_s = 0.0;
  double approach_speed_m_s = 0.0;
  double search_speed_m_s = 0.0;
};

/// Commands in SI units. Only for commands that were not refused.
TouchMotion touch_motion(const cs8::Touch& command);
std::vector<calib::JointVector> travel_waypoints(const cs8::Travel& command);

}  // namespace sim
