#pragma once

#include <optional>

#include "config/cell.hpp"

namespace cell {

/// Sum of the arm's lengths, metres: nothing that is farther from axis 1 is reached.
double reach_of(const calib::KinematicModel& model);

/// What is too near to the arm in its park posture, if anything.
std::optional<calib::Clash> park_clash(const Cell& scene);

/// A posture to park in: clear of all that is around, the stylus over the block and pointing down where that
/// is possible. Where none is clear, the middle of the joints' ranges. The same scene gives the same posture.
calib::JointVector find_park_posture(const Cell& scene);

}  // namespace cell
