#pragma once

#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/motion/swept_collision.hpp"

namespace calib {

/// What the arm moves in between touches. Made once for many ways.
class TransferSpace {
 public:
  /// `clearance_m` is kept by every body to every obstacle; the park posture is free of obstacles, with the
  /// arm raised.
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

/// A way has at most this many postures between its ends.
inline constexpr std::size_t kTransferPosturesMax = 4;

/// Postures that lead from `from` to `to` in straight joint moves, all clear; neither end included, empty
/// when the direct move is clear. Tried, the shortest first: the direct move and ways through the park
/// posture and through raised postures, which have joints 2 and 3 (one or both) where the park posture has
/// them and the others as at the end they belong to. Nothing when none of them is clear, as from a start
/// inside the clearance.
std::optional<std::vector<JointVector>> find_way(const TransferSpace& space, const JointVector& from,
                                                 const JointVector& to);

/// Both ends and what is between.
std::vector<JointVector> whole_way(const JointVector& from, const std::vector<JointVector>& via,
                                   const JointVector& to);

/// The posture on the straight joint move that is nearest to this one, by the length of the joint vector.
JointVector nearest_on_move(const JointVector& from, const JointVector& to, const JointVector& joints);

/// Whether find_way leads to the park posture with at most one posture between. Two postures for which this
/// holds always have a way from one to the other.
bool is_near_park(const TransferSpace& space, const JointVector& joints);

}  // namespace calib
