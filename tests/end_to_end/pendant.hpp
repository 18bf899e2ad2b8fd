#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/end_to_end/loopback_cell.hpp"

namespace touchcal::testing {

/// A person with the pendant at the simulated cell: jogs the true arm to faces as they truly stand.
class Pendant {
 public:
  /// The block of `loop` stands where `there`, the true cell, has it; the plant that is served is made of it.
  Pendant(LoopbackCell& loop, cell::Cell there, sim::Plant plant);

  /// Manual mode with power, and back to remote mode, the arm at the park posture.
  void take_over();
  void hand_back();

  /// Brings the ball to a point of a face until the probe trips and the daemon was told, then back.
  void touch(int face, const Eigen::Vector3d& point_m);
  /// The same in a posture near this one.
  void touch_near(int face, const calib::JointVector& joints);
  /// The same with a tip that trips nothing: where it just touches, `at_contact` is called.
  void touch_by_word(int face, const calib::JointVector& joints, const std::function<void()>& at_contact);

 private:
  struct Way {
    Eigen::Isometry3d pose;
    calib::JointVector joints;
  };
  [[nodiscard]] std::vector<Way> ways_to(const calib::Face& face, const Eigen::Vector3d& point_m) const;
  void jog(const cell::JogOrder& order);
  void go(const calib::JointVector& joints);
  void touch_in(int face, const Eigen::Isometry3d& true_pose, const calib::JointVector& near);
  void wait_until_told();

  LoopbackCell& loop_;
  cell::Cell there_;
  sim::Plant plant_;
};

}  // namespace touchcal::testing
