#pragma once

#include <cmath>
#include <stdexcept>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "ride.hpp"

/// The cell whose probe has four further tips, and touches with them.
namespace sim::testing {

inline const cell::Cell& star() {
  static const cell::Cell cell = read_cell("star");
  return cell;
}

inline const cell::ProbeTip& tip_named(const std::string& name) {
  return *std::ranges::find(star().probe.tips, name, &cell::ProbeTip::name);
}

inline cell::Truth star_truth() { return cell::read_truth(cell_folder("star") + "/truth.json"); }

/// Without noise, so that a trip is where it must be.
inline Plant quiet_star(const cell::Truth& truth) {
  Plant plant = make_plant(star(), truth);
  plant.touch_noise_m = 0.0;
  return plant;
}

/// How far the stylus leans over a tip's stem towards the face, so that its body keeps away from it.
inline constexpr double kLeanRad = calib::radians_from_degrees(25.0);

/// A search with the ball of a further tip, along the inward normal onto the middle of a face.
struct TipTouch {
  calib::JointVector approach;
  calib::JointVector search_end;
  calib::Face face;
  Eigen::Vector3d way_in_tool;  // of the search, in R_7
};

/// Whether nominal and true arm trip in the search and meet nothing else.
inline bool is_clear(const TipTouch& touch) {
  for (const cell::Truth& truth : {cell::Truth{}, star_truth()}) {
    Ride ride(quiet_star(truth));
    if (!ride.plant.joint_ranges.contains(touch.approach) ||
        !ride.plant.joint_ranges.contains(touch.search_end) ||
        !straight_line(ride.plant, touch.approach, touch.search_end).complete ||
        !ride.search(touch.approach, touch.search_end) || !ride.collision.empty())
      return false;
  }
  return true;
}

/// The first turn about the normal in which it is clear.
inline TipTouch touch_with(const cell::ProbeTip& tip, int face_index) {
  const calib::KinematicModel& arm = star().arm.model;
  const calib::Face& face = star().block.faces.at(static_cast<std::size_t>(face_index));
  const Eigen::Vector3d inward = -face.plane.outward;
  const Eigen::Vector3d way_in_tool =
      std::cos(kLeanRad) * tip.direction + std::sin(kLeanRad) * Eigen::Vector3d::UnitZ();
  const Eigen::Quaterniond onto_face = calib::shortest_rotation(way_in_tool, inward);
  for (int spin = 0; spin < 36; ++spin) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::AngleAxisd(calib::radians_from_degrees(10.0 * spin), inward) * onto_face.toRotationMatrix();
    const auto at_height = [&](double height_m) {
      pose.translation() = face.center_m - (tip.radius_m + height_m) * inward - pose.linear() * tip.center_m;
      return pose;
    };
    for (const calib::JointVector& approach :
         calib::inverse_kinematics(arm, star().arm.joint_ranges, at_height(kStandoffMetres))) {
      const auto end = calib::solve_near(arm, at_height(-kStandoffMetres), approach);
      if (!end) continue;
      const TipTouch touch{approach, *end, face, way_in_tool};
      if (is_clear(touch)) return touch;
    }
  }
  throw std::logic_error("no posture for the touch with this tip");
}

}  // namespace sim::testing
