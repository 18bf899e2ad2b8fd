#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"

namespace cell {

/// Sum of the arm's lengths, metres: nothing that is farther from axis 1 is reached.
double reach_of(const calib::KinematicModel& model);

/// What is too near to the arm in its park posture, if anything: nearer than the arm may miss, by which a
/// plan is refused.
std::optional<calib::Clash> park_clash(const Cell& scene);

/// What is in the way in most of the postures that find_park_posture() tries, and in which share of them.
struct ParkObstruction {
  std::string body;
  std::string other;
  double share = 0.0;
};
/// Nothing where one of them is clear.
std::optional<ParkObstruction> park_obstruction(const Cell& scene);

/// A posture to park in: clear of all that is around, by 50 mm more than it must be where that is possible,
/// the stylus over the block and pointing down. Where none is clear, the middle of the joints' ranges. The
/// same scene gives the same posture.
calib::JointVector find_park_posture(const Cell& scene);

}  // namespace cell
