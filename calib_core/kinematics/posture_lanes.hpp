#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// Kinematics of four postures of one arm at once, one in each lane of a vector register. The same formulas
/// as forward_chain() and distance_derivatives(), and equal to them up to rounding.
namespace calib {

inline constexpr std::size_t kLaneCount = 4;

/// One number of each posture.
struct alignas(kLaneCount * sizeof(double)) Lanes {
  std::array<double, kLaneCount> of;
};

struct CosSinLanes {
  Lanes cos, sin;
};

/// Four joint vectors; `turned` as in PreparedJoints, set by LaneArithmetic::turn.
struct PostureLanes {
  std::array<Lanes, kJointCount> joints;
  std::array<CosSinLanes, kJointCount> turned;

  void set(std::size_t lane, const JointVector& posture) {
    for (std::size_t joint = 0; joint < kJointCount; ++joint)
      joints[joint].of[lane] = posture[static_cast<Eigen::Index>(joint)];
  }
};

struct VectorLanes {
  Lanes x, y, z;

  void set(std::size_t lane, const Eigen::Vector3d& vector) {
    x.of[lane] = vector.x();
    y.of[lane] = vector.y();
    z.of[lane] = vector.z();
  }
  [[nodiscard]] Eigen::Vector3d of(std::size_t lane) const { return {x.of[lane], y.of[lane], z.of[lane]}; }
};

/// As Chain: axes and origins of the frames in the block's frame R_-1.
struct ChainLanes {
  struct Frame {
    VectorLanes x, y, z, origin_m;
  };
  std::array<Frame, kFrameCount> frames;
  std::array<CosSinLanes, kJointCount> turned;
  std::array<CosSinLanes, kJointCount> ripple_phases;  // set only of an arm with periods

  [[nodiscard]] Eigen::Vector3d tip_in_block_m(std::size_t lane) const {
    return frames.back().origin_m.of(lane);
  }
  /// A vector of R_-1 in R_7.
  [[nodiscard]] Eigen::Vector3d in_frame_7(std::size_t lane, const Eigen::Vector3d& vector) const {
    const Frame& frame = frames.back();
    return {frame.x.of(lane).dot(vector), frame.y.of(lane).dot(vector), frame.z.of(lane).dot(vector)};
  }
  /// Pose of R_7.
  [[nodiscard]] Eigen::Isometry3d block_from_tip(std::size_t lane) const {
    const Frame& frame = frames.back();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << frame.x.of(lane), frame.y.of(lane), frame.z.of(lane);
    pose.translation() = frame.origin_m.of(lane);
    return pose;
  }
};

/// As ball_at_m().
inline Eigen::Vector3d ball_at_m(const ContactSurface& surface, const ChainLanes& chains, std::size_t lane) {
  if (surface.ball_m.isZero(0.0)) return chains.tip_in_block_m(lane);
  return ball_at_m(surface, chains.block_from_tip(lane));
}

/// Of a touch: as signed_distance_m() of the tip's pose.
inline double signed_distance_m(const ContactSurface& surface, const ChainLanes& chains, std::size_t lane) {
  if (surface.sideways.is_zero()) return signed_distance_m(surface, ball_at_m(surface, chains, lane));
  return signed_distance_m(surface, chains.block_from_tip(lane));
}

/// Of each posture a point that R_7 moves, the ball, and a direction along which it moves: the normal of the
/// surface.
struct BallLanes {
  VectorLanes center_m, outward;

  void set(std::size_t lane, const ContactSurface& surface, const ChainLanes& chains) {
    const Eigen::Vector3d ball_m = ball_at_m(surface, chains, lane);
    center_m.set(lane, ball_m);
    outward.set(lane, normal_at(surface, ball_m));
  }
};

/// Derivatives of each posture's distance, as ArmRow.
using ArmRowLanes = std::array<Lanes, kArmParameterCount>;

/// Calls for_block(first, count) for each four of `total` and for what is left at the end.
template <class ForBlock>
void for_each_block(std::size_t total, const ForBlock& for_block) {
  for (std::size_t first = 0; first < total; first += kLaneCount)
    for_block(first, std::min(kLaneCount, total - first));
}

struct LaneArithmetic {
  /// Sets the sines and cosines from the joints.
  void (*turn)(const std::array<double, kJointCount>& gains, PostureLanes& postures);
  void (*forward_chains)(const PreparedModel& model, const PostureLanes& postures, ChainLanes& chains);
  void (*distance_derivatives)(const PreparedModel& model, const ChainLanes& chains, const BallLanes& balls,
                               ArmRowLanes& rows);
};

/// For the registers of this processor.
const LaneArithmetic& lane_arithmetic();

/// For those that every processor has.
const LaneArithmetic& narrow_lane_arithmetic();

}  // namespace calib
