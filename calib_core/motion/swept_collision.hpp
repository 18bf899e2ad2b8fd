#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"

namespace calib {

/// How much nearer than the clearance two things may come between the postures that find_clash_on_way looks
/// at.
inline constexpr double kSweptErrorMaxMetres = 1e-3;

/// Looks for what is too near on straight joint moves of one arm in one scene: find_clash on the whole of a
/// move, both ends included. Conservative advancement: a pair is looked at again when the joints have gone
/// far enough to use up the distance it had (Mirtich, Impulse-based dynamic simulation of rigid body systems,
/// 1996), counted along the normal at the nearest points where speed and acceleration allow more; so nothing
/// deeper than kSweptErrorMaxMetres is missed.
class SweptCollision {
 public:
  SweptCollision(const CollisionScene& scene, const KinematicModel& model, double clearance_m);

  [[nodiscard]] std::optional<Clash> find_clash(const JointVector& from, const JointVector& to) const;

 private:
  /// Two things that may meet; indices into the scene.
  struct Pair {
    std::size_t body = 0;
    std::size_t other = 0;  // an obstacle, or another body
    bool is_obstacle = false;
    double spent_m = 0.0;   // radii and clearance
    JointVector levers_m;   // metres that they come nearer at most for each radian of each joint
    JointVector reaches_m;  // obstacles: the body's distance from each joint's origin at most
  };
  struct Motion;

  [[nodiscard]] double safe_share(const Pair& pair, const Motion& motion, const Segment& body,
                                  const Eigen::Vector3d& gap_m) const;
  [[nodiscard]] Clash clash(const Pair& pair, double gap_m) const;

  CollisionScene scene_;
  PreparedModel prepared_;
  std::vector<Pair> pairs_;
};

/// SweptCollision for a single move.
std::optional<Clash> find_clash_on_way(const CollisionScene& scene, const KinematicModel& model,
                                       const JointVector& from, const JointVector& to, double clearance_m);

}  // namespace calib
