#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/joint_vector.hpp"
#include "cs8_protocol/messages.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// One move of a command and how long it takes in simulated time.
struct Leg {
  cs8::Phase phase = cs8::Phase::kIdle;
  Stretch stretch;
  double duration_s = 0.0;
};

/// The latched contact of a search, and where the arm came to rest behind it.
struct Capture {
  calib::JointVector contact;
  calib::JointVector stopped;
  double overtravel_m = 0.0;
  double at_s = 0.0;  // simulated time of the edge, from the start of the command
};

/// A motion command as it will go when nothing interferes, worked out from geometry when it is taken.
/// A retract goes back over what was just travelled, so nothing new can be met on it and it is not looked at.
struct Timeline {
  std::vector<Leg> legs;
  cs8::Outcome outcome = cs8::Outcome::kArrived;
  cs8::Phase phase = cs8::Phase::kIdle;  // reached when it ends early
  std::int32_t error_number = 0;
  std::optional<Capture> capture;
  std::vector<Stretch> way_out;  // where it ends near a face: the way back to where the arm is clear
  std::string collision;         // which body hit what, when that is the outcome

  [[nodiscard]] double duration_s() const;
};

/// Where a timeline is at a time.
struct Place {
  std::size_t leg = 0;
  double share = 1.0;  // of the leg's stretch
  cs8::Phase phase = cs8::Phase::kIdle;
  calib::JointVector joints;
};

/// The place after `time_s`; `start` is where a timeline without legs stands.
Place place_at(const Timeline& timeline, double time_s, const calib::JointVector& start);

/// The way back from a place near a face to where the arm is clear of it; empty from a travel.
std::vector<Stretch> way_out_from(const std::vector<Leg>& legs, std::size_t leg, double share);

struct TouchMotion {
  std::vector<calib::JointVector> waypoints;  // the last is the clear posture
  calib::JointVector approach;
  calib::JointVector search_end;
  double travel_speed_m_s = 0.0;
  double approach_speed_m_s = 0.0;
  double search_speed_m_s = 0.0;
};

/// A guarded touch. `noise_m` is added to the trip distance in the search: positive trips early.
Timeline touch_timeline(const Plant& plant, const calib::JointVector& start, const TouchMotion& motion,
                        double noise_m);

/// Guarded joint moves through the waypoints.
Timeline travel_timeline(const Plant& plant, const calib::JointVector& start,
                         const std::vector<calib::JointVector>& waypoints, double speed_m_s);

/// Back along stretches that were travelled before.
Timeline retract_timeline(const Plant& plant, const std::vector<Stretch>& way_out, double speed_m_s);

}  // namespace sim
