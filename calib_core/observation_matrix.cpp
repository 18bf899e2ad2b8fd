#include "calib_core/observation_matrix.hpp"

#include <cmath>

namespace calib {
namespace {

constexpr int kMoveStepsMax = 12;
constexpr double kOnPlaneMetres = 1e-15;

/// Factor that turns a signed distance into the formulation's row.
double row_factor(const Plane& plane, Formulation formulation) {
  return formulation == Formulation::kSignedDistance ? 1.0 : -1.0 / plane.offset_m;
}

}  // namespace

Observation observe(const KinematicModel& model, std::span<const Plane> contact_planes,
                    std::span<const Touch> touches, Formulation formulation) {
  const auto count = static_cast<Eigen::Index>(touches.size());
  Observation observation{
      Eigen::Matrix<double, Eigen::Dynamic, kErrorParameterCount>(count, kErrorParameterCount),
      Eigen::VectorXd(count)};
  for (Eigen::Index row = 0; row < count; ++row) {
    const Touch& touch = touches[static_cast<std::size_t>(row)];
    const Plane& plane = contact_planes[static_cast<std::size_t>(touch.face)];
    const Chain chain = forward_chain(model, touch.joints);
    const double factor = row_factor(plane, formulation);
    observation.matrix.row(row) = factor * plane.outward.transpose() * tip_derivatives(model, chain);
    observation.output_error[row] = -factor * signed_distance_m(plane, chain.tip_in_block_m());
  }
  return observation;
}

Eigen::VectorXd signed_distances_m(const KinematicModel& model, std::span<const Plane> contact_planes,
                                   std::span<const Touch> touches) {
  Eigen::VectorXd distances(static_cast<Eigen::Index>(touches.size()));
  for (Eigen::Index row = 0; row < distances.size(); ++row) {
    const Touch& touch = touches[static_cast<std::size_t>(row)];
    distances[row] = signed_distance_m(contact_planes[static_cast<std::size_t>(touch.face)],
                                       forward_kinematics(model, touch.joints).translation());
  }
  return distances;
}

Touch moved_onto_plane(const KinematicModel& model, const Plane& contact_plane, const Touch& touch) {
  Touch moved = touch;
  for (int step = 0; step < kMoveStepsMax; ++step) {
    const Chain chain = forward_chain(model, moved.joints);
    const double distance = signed_distance_m(contact_plane, chain.tip_in_block_m());
    if (std::abs(distance) < kOnPlaneMetres) break;
    const Eigen::Matrix<double, 1, kJointCount> slope =
        contact_plane.outward.transpose() * tip_jacobian(model, chain);
    const double squared = slope.squaredNorm();
    if (squared < 1e-12) break;  // no joint moves the tip along the normal here
    moved.joints -= slope.transpose() * (distance / squared);
  }
  return moved;
}

}  // namespace calib
