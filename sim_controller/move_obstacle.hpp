#pragma once

#include <string>

#include "sim_controller/controller_arm.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/val3/machine/system.hpp"

namespace sim {

/// Why the arm cannot make a move, for the log: joint range, reach, configuration, singular posture or arc,
/// with the joint or the place where that is known, angles in degrees. `way`: what was planned for it from
/// the posture `from`; the order or the way is impossible.
std::string move_obstacle(const Plant& plant, const ControllerArm& arm, const val3::MoveOrder& order,
                          const calib::JointVector& from, const ToolPath& way);

/// "movel at start.pgx:7 of task main~: " and why.
std::string impossible_move_text(const val3::MoveOrder& order, const std::string& why);

}  // namespace sim
