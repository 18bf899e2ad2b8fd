#pragma once

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "calib_core/inverse_kinematics.hpp"
#include "calib_core/observation_matrix.hpp"
#include "calib_core/touch_candidate.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

/// An arm with all 37 errors that touches the paper's four faces in well-spread postures: the simulated
/// calibrations of issue 3. The same seed gives the same touches on every machine.
namespace calib::study {

inline constexpr double kTouchNoiseMetres = 20e-6;
inline constexpr int kTouchesPerFace = 37;

/// A normal deviate (Box and Muller).
inline double normal(UniformChance& chance) {
  const double radius = std::sqrt(-2.0 * std::log1p(-chance()));
  return radius * std::cos(2.0 * std::numbers::pi * chance());
}

/// Table III and, one standard deviation, 0.2 mm and 0.5 mrad on all 37.
inline ErrorVector draw_errors(UniformChance& chance) {
  ErrorVector errors = paper::table3();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const bool is_length = error_parameters()[static_cast<std::size_t>(i)].is_length();
    errors[i] += (is_length ? 0.2e-3 : 0.5e-3) * normal(chance);
  }
  return errors;
}

/// Joints at which the true arm's tip is exactly on the face, and the smallest displacement of them that
/// takes it one metre along the outward normal (to first order).
struct ExactTouch {
  Touch touch;
  JointVector joints_per_metre;
};

/// Faces take turns. Points, tilts to 45 degrees and turns are even, the postures within the joint ranges;
/// nothing is checked for collisions.
inline std::vector<ExactTouch> exact_touches(const KinematicModel& truth, int per_face,
                                             UniformChance& chance) {
  const std::vector<Plane> planes = paper::planes();
  const std::vector<Face> faces = tx90::faces();
  const PlanningProblem cell{.nominal_miss_m = 0.012, .tilt_max_rad = radians_from_degrees(45.0)};
  std::vector<ExactTouch> touches;
  for (int k = 0; k < per_face; ++k) {
    for (std::size_t face = 0; face < planes.size(); ++face) {
      std::vector<JointVector> postures;
      for (int attempt = 0; postures.empty(); ++attempt) {
        if (attempt == 1000) throw std::logic_error("the face is out of the arm's reach");
        const TouchPose pose = sample_touch_pose(cell, faces[face], chance);
        postures = inverse_kinematics(paper::nominal(), tx90::joint_ranges(), pose.block_from_tip);
      }
      const auto pick = static_cast<std::size_t>(chance() * static_cast<double>(postures.size()));
      const Touch touch =
          moved_onto_plane(truth, planes[face], {.face = static_cast<int>(face), .joints = postures[pick]});
      const JointVector slope =
          tip_jacobian(truth, forward_chain(truth, touch.joints)).transpose() * planes[face].outward;
      touches.push_back({touch, slope / slope.squaredNorm()});
    }
  }
  return touches;
}

/// What a probe with noise along the normal captures.
inline std::vector<Touch> with_noise(const std::vector<ExactTouch>& exact, double std_m,
                                     UniformChance& chance) {
  std::vector<Touch> touches;
  touches.reserve(exact.size());
  for (const ExactTouch& one : exact) {
    touches.push_back(one.touch);
    touches.back().joints += std_m * normal(chance) * one.joints_per_metre;
  }
  return touches;
}

}  // namespace calib::study
