#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"

namespace calib {

/// How much closer than the clearance two objects may come between the postures that are checked.
inline constexpr double kSweptErrorMaxMetres = 1e-3;

/// Collision check of straight joint moves: find_clash on the whole move, both ends included. Conservative
/// advancement (Mirtich, Impulse-based dynamic simulation of rigid body systems, 1996): a pair is checked
/// again when the joints may have moved far enough to close its distance. For obstacles, bounds on speed and
/// acceleration along the normal at the nearest points allow longer steps. Nothing deeper than
/// kSweptErrorMaxMetres is missed.
class SweptCollision {
 public:
  SweptCollision(const CollisionScene& scene, const KinematicModel& model, double clearance_m);

  [[nodiscard]] std::optional<Clash> find_clash(const JointVector& from, const JointVector& to) const;

 private:
  /// Two objects that may collide; indices into the scene.
  struct Pair {
    std::size_t body = 0;
    std::size_t other = 0;  // an obstacle, or another body
    bool is_obstacle = false;
    double required_m = 0.0;  // required distance of the axes: radii and clearance
    JointVector levers_m;     // largest approach per radian of each joint
    JointVector reaches_m;    // obstacles: largest distance of the body from each joint's origin
  };
  struct Motion;

  [[nodiscard]] double safe_step(const Pair& pair, const Motion& motion, const Segment& body,
                                 const Eigen::Vector3d& gap_m) const;
  [[nodiscard]] Clash clash(const Pair& pair, double gap_m) const;

  CollisionScene scene_;
  PreparedModel prepared_;
  std::vector<Pair> pairs_;
};

/// SweptCollision for a single move.
std::optional<Clash> find_clash_on_move(const CollisionScene& scene, const KinematicModel& model,
                                        const JointVector& from, const JointVector& to, double clearance_m);

}  // namespace calib
