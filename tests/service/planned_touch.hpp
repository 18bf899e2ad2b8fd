#pragma once

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "cs8_protocol/messages.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {

/// Where the nominal tip is `off_m` from where these joints have it.
inline calib::JointVector nominal_joints_off(const calib::JointVector& start, const Eigen::Vector3d& off_m) {
  Eigen::Isometry3d pose = calib::forward_kinematics(edf().arm.model, start);
  pose.translation() += off_m;
  return calib::solve_near(edf().arm.model, pose, start).value();
}

/// A touch in the middle of a search of 30 mm.
inline calib::PlannedTouch planned_touch() {
  const calib::Touch& touch = table3_touches().front();
  const calib::Plane& plane = edf().block.faces[static_cast<std::size_t>(touch.face)].plane;
  return {.face = touch.face,
          .joints = touch.joints,
          .clear_joints = calib::JointVector::Constant(0.1),
          .approach_joints = nominal_joints_off(touch.joints, 0.015 * plane.outward),
          .search_end_joints = nominal_joints_off(touch.joints, -0.015 * plane.outward),
          .search_direction = -plane.outward,
          .search_length_m = 0.03};
}

inline cs8::JointsMicrodeg joints_off(const Eigen::Vector3d& off_m) {
  return to_wire(nominal_joints_off(planned_touch().joints, off_m));
}

/// What a contact is reported as when the nominal tip is `off_m` from the planned touch, both times.
inline cs8::TouchResult contact(const Eigen::Vector3d& off_m) {
  return {.outcome = cs8::Outcome::kContact,
          .source = cs8::CaptureSource::kLatched,
          .contact = joints_off(off_m),
          .search_speed_um_s = cs8::um_s_from_metres_per_second(edf().speeds.contact_m_s()),
          .monitor_speed_percent = 100,
          .first_source = cs8::CaptureSource::kLatched,
          .first_contact = joints_off(off_m),
          .edges = 1};
}

}  // namespace cell
