#include "calib_core/observability/observation_matrix.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib_core/kinematics/posture_lanes.hpp"

namespace calib {
namespace {

constexpr int kMoveStepsMax = 12;
/// Newton's method converges quadratically: the next distance is this one squared over the size of the arm.
constexpr double kLastStepMetres = 1e-8;
constexpr double kOnPlaneMetres = 1e-14;    // two digits above the rounding error at a reach of 1 m
constexpr double kSlopeSquaredMin = 1e-12;  // below, no joint moves the tip along the normal

/// Up to four touches; where there are fewer, the last one fills the other lanes.
struct TouchBlock {
  PostureLanes postures;
  std::array<const ContactSurface*, kLaneCount> surfaces{};

  TouchBlock(std::span<const ContactSurface> contact_planes, std::span<const Touch> touches) {
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      const Touch& touch = touches[std::min(lane, touches.size() - 1)];
      postures.set(lane, touch.joints);
      surfaces[lane] = &contact_planes[static_cast<std::size_t>(touch.face)];
    }
  }
  [[nodiscard]] double distance_m(const ChainLanes& chains, std::size_t lane) const {
    return signed_distance_m(*surfaces[lane], chains, lane);
  }
  [[nodiscard]] BallLanes balls(const ChainLanes& chains) const {
    BallLanes balls;
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) balls.set(lane, *surfaces[lane], chains);
    return balls;
  }
};

/// moved_onto_plane() of a block.
void move_block(const PreparedModel& model, TouchBlock& block) {
  const LaneArithmetic& lanes = lane_arithmetic();
  ChainLanes chains;
  ArmRowLanes slopes;
  std::array<bool, kLaneCount> arrived{};
  for (int step = 0; step < kMoveStepsMax && std::ranges::find(arrived, false) != arrived.end(); ++step) {
    lanes.turn(model.model.gains, block.postures);
    lanes.forward_chains(model, block.postures, chains);
    lanes.distance_derivatives(model, chains, block.balls(chains), slopes);
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      if (arrived[lane]) continue;
      const double distance = block.distance_m(chains, lane);
      JointVector slope;
      for (int joint = 0; joint < kJointCount; ++joint) {
        const auto index = static_cast<std::size_t>(joint);
        const auto theta = static_cast<std::size_t>(theta_index(joint));
        const bool turns = model.model.joint_types[index] == JointType::kRevolute;
        slope[joint] = model.model.gains[index] * slopes[turns ? theta : theta + 1].of[lane];
      }
      const double squared = slope.squaredNorm();
      arrived[lane] = std::abs(distance) < kLastStepMetres || squared < kSlopeSquaredMin;
      if (std::abs(distance) < kOnPlaneMetres || squared < kSlopeSquaredMin) continue;
      for (std::size_t joint = 0; joint < kJointCount; ++joint)
        block.postures.joints[joint].of[lane] -=
            slope[static_cast<Eigen::Index>(joint)] * (distance / squared);
    }
  }
}

}  // namespace

Observation observe(const KinematicModel& model, std::span<const ContactSurface> contact_planes,
                    std::span<const Touch> touches, Formulation formulation) {
  const auto count = static_cast<Eigen::Index>(touches.size());
  const PreparedModel prepared = prepare(model);
  const LaneArithmetic& lanes = lane_arithmetic();
  Observation observation{
      Eigen::Matrix<double, Eigen::Dynamic, kErrorParameterCount>(count, kErrorParameterCount),
      Eigen::VectorXd(count)};
  for_each_block(touches.size(), [&](std::size_t first, std::size_t block_count) {
    const std::span<const Touch> here = touches.subspan(first, block_count);
    TouchBlock block(contact_planes, here);
    ChainLanes chains;
    ArmRowLanes slopes;
    lanes.turn(prepared.model.gains, block.postures);
    lanes.forward_chains(prepared, block.postures, chains);
    lanes.distance_derivatives(prepared, chains, block.balls(chains), slopes);
    for (std::size_t lane = 0; lane < block_count; ++lane) {
      const auto row = static_cast<Eigen::Index>(first + lane);
      const double factor =
          row_factor(contact_planes[static_cast<std::size_t>(here[lane].face)], formulation);
      for (int column = 0; column < kErrorParameterCount; ++column)
        observation.matrix(row, column) = factor * slopes[static_cast<std::size_t>(column)].of[lane];
      observation.output_error[row] = -factor * block.distance_m(chains, lane);
    }
  });
  return observation;
}

void weigh_rows(Observation& observation, std::span<const Touch> touches, double declared_noise_m) {
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double factor = noise_factor(touches[i], declared_noise_m);
    if (factor == 1.0) continue;  // of nearly all, and a row of a matrix by columns is slow to write
    observation.matrix.row(row) /= factor;
    observation.output_error[row] /= factor;
  }
}

Eigen::VectorXd signed_distances_m(const KinematicModel& model,
                                   std::span<const ContactSurface> contact_planes,
                                   std::span<const Touch> touches) {
  const PreparedModel prepared = prepare(model);
  const LaneArithmetic& lanes = lane_arithmetic();
  Eigen::VectorXd distances(static_cast<Eigen::Index>(touches.size()));
  for_each_block(touches.size(), [&](std::size_t first, std::size_t count) {
    TouchBlock block(contact_planes, touches.subspan(first, count));
    ChainLanes chains;
    lanes.turn(prepared.model.gains, block.postures);
    lanes.forward_chains(prepared, block.postures, chains);
    for (std::size_t lane = 0; lane < count; ++lane)
      distances[static_cast<Eigen::Index>(first + lane)] = block.distance_m(chains, lane);
  });
  return distances;
}

std::vector<Touch> moved_onto_planes(const KinematicModel& model,
                                     std::span<const ContactSurface> contact_planes,
                                     std::vector<Touch> touches) {
  const PreparedModel prepared = prepare(model);
  for_each_block(touches.size(), [&](std::size_t first, std::size_t count) {
    TouchBlock block(contact_planes, std::span(touches).subspan(first, count));
    move_block(prepared, block);
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t joint = 0; joint < kJointCount; ++joint)
        touches[first + lane].joints[static_cast<Eigen::Index>(joint)] =
            block.postures.joints[joint].of[lane];
    }
  });
  return touches;
}

Touch moved_onto_plane(const PreparedModel& model, const ContactSurface& contact_plane, const Touch& touch) {
  Touch moved = touch;
  for (int step = 0; step < kMoveStepsMax; ++step) {
    const Chain chain = forward_chain(model, moved.joints);
    const double distance = signed_distance_m(contact_plane, chain.block_from_frame.back());
    if (std::abs(distance) < kOnPlaneMetres) break;
    const BallContact contact = contact_at(contact_plane, chain.block_from_frame.back());
    const Eigen::Matrix<double, 1, kJointCount> slope =
        contact.normal.transpose() * point_jacobian(model.model, chain, contact.ball_m);
    const double squared = slope.squaredNorm();
    if (squared < kSlopeSquaredMin) break;
    moved.joints -= slope.transpose() * (distance / squared);
    if (std::abs(distance) < kLastStepMetres) break;
  }
  return moved;
}

Touch moved_onto_plane(const KinematicModel& model, const ContactSurface& contact_plane, const Touch& touch) {
  return moved_onto_plane(prepare(model), contact_plane, touch);
}

}  // namespace calib
