#pragma once

#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/motion/swept_collision.hpp"

namespace calib {

/// The collision scene and park posture for moves between touches. Construct it once for many paths.
class TransferSpace {
 public:
  /// Every body keeps `clearance_m` to every obstacle. The park posture has the arm raised, clear of
  /// obstacles.
  TransferSpace(const KinematicModel& model, const CollisionScene& scene, const JointVector& park_joints,
                double clearance_m)
      : collision_(scene, model, clearance_m), park_joints_(park_joints) {}

  [[nodiscard]] bool is_clear(const JointVector& from, const JointVector& to) const {
    return !collision_.find_clash(from, to);
  }
  [[nodiscard]] const JointVector& park_joints() const { return park_joints_; }

 private:
  SweptCollision collision_;
  JointVector park_joints_;
};

/// Largest number of postures between the ends of a path.
inline constexpr std::size_t kTransferPosturesMax = 4;

/// Intermediate postures of a clear path of straight joint moves from `from` to `to`; empty when the direct
/// move is clear. Candidates, the shortest first: the direct move, and paths through the park posture and
/// through raised postures. A raised posture is that of an end with joint 2, joint 3 or both moved to their
/// positions in the park posture. Nothing when no candidate is clear, for example when `from` violates the
/// clearance.
std::optional<std::vector<JointVector>> find_path(const TransferSpace& space, const JointVector& from,
                                                  const JointVector& to);

/// The path with both ends.
std::vector<JointVector> whole_path(const JointVector& from, const std::vector<JointVector>& via,
                                    const JointVector& to);

/// The posture on the straight joint move that is nearest to `joints` in joint space.
JointVector nearest_on_move(const JointVector& from, const JointVector& to, const JointVector& joints);

/// Whether find_path leads to the park posture with at most one intermediate posture. Between any two
/// postures for which this holds there is a path.
bool can_reach_park(const TransferSpace& space, const JointVector& joints);

}  // namespace calib
