#pragma once

#include <optional>
#include <string>

#include "calib_core/geometry/joint_vector.hpp"

namespace cell {

/// What a person who touches by hand is told: in the status, as long as touches are awaited.
struct HandGuide {
  std::string activity;  // "locate", "guided"
  /// What is awaited: "touch"; "undo", as the touches give no place; "pass", once around the block that was
  /// found; "passing", the arm goes around it.
  std::string step = "touch";
  int plane = 0;  // the face to touch, from 1
  int index = 0;  // of the touch, from 1
  int total = 0;
  std::string words;                               // what to do
  std::optional<std::string> problem;              // why the last touch did not count, or what else is wrong
  std::optional<calib::JointVector> about_joints;  // roughly the posture, where one is asked for

  bool operator==(const HandGuide&) const = default;
};

}  // namespace cell
