#pragma once

#include <vector>

#include "calib_core/geometry/touch.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

/// An arm with all 37 errors that touches the paper's four faces in well-spread postures: the simulated
/// calibrations of issue 3. The same seed gives the same touches on every machine.
namespace calib::study {

inline constexpr double kTouchNoiseMetres = 20e-6;
inline constexpr int kTouchesPerFace = 37;

/// A normal deviate (Box and Muller).
double normal(UniformChance& chance);

/// Table III and, one standard deviation, 0.2 mm and 0.5 mrad on all 37.
ErrorVector draw_errors(UniformChance& chance);

/// Joints at which the true arm's tip is exactly on the face, and the smallest displacement of them that
/// takes it one metre along the outward normal (to first order).
struct ExactTouch {
  Touch touch;
  JointVector joints_per_metre;
};

/// Faces take turns. Points, tilts to 45 degrees and turns are even, the postures within the joint ranges;
/// nothing is checked for collisions.
std::vector<ExactTouch> exact_touches(const KinematicModel& truth, int per_face, UniformChance& chance);

/// What a probe with noise along the normal captures.
std::vector<Touch> with_noise(const std::vector<ExactTouch>& exact, double std_m, UniformChance& chance);

}  // namespace calib::study
