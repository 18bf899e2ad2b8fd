#include "tests/calib_core/block_study.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/planning/touch_feasibility.hpp"

namespace calib::study {

double normal(UniformChance& chance) {
  const double radius = std::sqrt(-2.0 * std::log1p(-chance()));
  return radius * std::cos(2.0 * std::numbers::pi * chance());
}

ErrorVector draw_errors(UniformChance& chance) {
  ErrorVector errors = paper::table3();
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const bool is_length = error_parameters()[static_cast<std::size_t>(i)].is_length();
    errors[i] += (is_length ? 0.2e-3 : 0.5e-3) * normal(chance);
  }
  return errors;
}

std::vector<ExactTouch> exact_touches(const KinematicModel& truth, int per_face, UniformChance& chance) {
  const std::vector<ContactSurface> planes = paper::planes();
  const std::vector<Face> faces = tx90::faces();
  const PlanningProblem cell{.nominal_position_error_m = 0.012, .tilt_max_rad = radians_from_degrees(45.0)};
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

std::vector<Touch> with_noise(const std::vector<ExactTouch>& exact, double std_m, UniformChance& chance) {
  std::vector<Touch> touches;
  touches.reserve(exact.size());
  for (const ExactTouch& one : exact) {
    touches.push_back(one.touch);
    touches.back().joints += std_m * normal(chance) * one.joints_per_metre;
  }
  return touches;
}

}  // namespace calib::study
