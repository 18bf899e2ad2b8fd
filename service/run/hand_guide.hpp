#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "calib_core/geometry/joint_vector.hpp"

namespace cell {

/// What touches by hand are made for.
enum class HandActivity { kLocate, kGuided, kTool };
std::string_view hand_activity_name(HandActivity activity);  // "locate", "guided", "tool"

/// What is awaited of the person.
enum class HandStep {
  kTouch,
  kUndo,     // the touches determine no pose of the block
  kPass,     // the pass around the located block is due
  kPassing,  // nothing: the arm goes around the block
};
std::string_view hand_step_name(HandStep step);  // "touch", "undo", "pass", "passing"

/// Instructions to a person who touches by hand: part of the status while touches are awaited.
struct HandGuide {
  HandActivity activity = HandActivity::kGuided;
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
