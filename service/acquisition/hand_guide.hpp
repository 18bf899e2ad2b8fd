#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "calib_core/joint_vector.hpp"

namespace cell {

/// What a person touches by hand for: to find the block, or to make a guided run's touches.
enum class HandActivity { kLocate, kGuided };
std::string_view hand_activity_name(HandActivity activity);  // "locate", as in the API

/// What is awaited.
enum class HandStep {
  kTouch,
  kUndo,     // the touches give no place: the last one is to be taken back
  kPass,     // once around the block that was found
  kPassing,  // of nobody: the arm goes around it
};
std::string_view hand_step_name(HandStep step);  // "touch", as in the API

/// What a person who touches by hand is told: in the status, as long as touches are awaited.
struct HandGuide {
  HandActivity activity = HandActivity::kLocate;
  HandStep step = HandStep::kTouch;
  int plane = 0;  // the face to touch, from 1
  int index = 0;  // of the touch, from 1
  int total = 0;
  std::string words;                               // what to do
  std::optional<std::string> problem;              // why the last touch did not count, or what else is wrong
  std::optional<calib::JointVector> about_joints;  // roughly the posture, where one is asked for

  bool operator==(const HandGuide&) const = default;
};

}  // namespace cell
