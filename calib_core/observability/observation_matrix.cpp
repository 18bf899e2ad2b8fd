#include "calib_core/observability/observation_matrix.hpp"

#include <cmath>

namespace calib {
namespace {

constexpr int kMoveStepsMax = 12;
/// Newton's method converges quadratically: the next distance is this one squared over the size of the arm.
constexpr double kLastStepMetres = 1e-8;
constexpr double kOnPlaneMetres = 1e-14;  // two digits above the rounding error at a reach of 1 m

}  // namespace

Observation observe(const KinematicModel& model, std::span<const Plane> contact_planes,
                    std::span<const Touch> touches, Formulation formulation) {
  const auto count = static_cast<Eigen::Index>(touches.size());
  const PreparedModel prepared = prepare(model);
  Observation observation{
      Eigen::Matrix<double, Eigen::Dynamic, kErrorParameterCount>(count, kErrorParameterCount),
      Eigen::VectorXd(count)};
  for (Eigen::Index row = 0; row < count; ++row) {
    const Touch& touch = touches[static_cast<std::size_t>(row)];
    const Plane& plane = contact_planes[static_cast<std::size_t>(touch.face)];
    const Chain chain = forward_chain(prepared, touch.joints);
    const double factor = row_factor(plane, formulation);
    observation.matrix.row(row) =
        factor * distance_derivatives(prepared, chain, plane.outward).head<kErrorParameterCount>();
    observation.output_error[row] = -factor * signed_distance_m(plane, chain.tip_in_block_m());
  }
  return observation;
}

Eigen::VectorXd signed_distances_m(const KinematicModel& model, std::span<const Plane> contact_planes,
                                   std::span<const Touch> touches) {
  const PreparedModel prepared = prepare(model);
  Eigen::VectorXd distances(static_cast<Eigen::Index>(touches.size()));
  for (Eigen::Index row = 0; row < distances.size(); ++row) {
    const Touch& touch = touches[static_cast<std::size_t>(row)];
    distances[row] = signed_distance_m(contact_planes[static_cast<std::size_t>(touch.face)],
                                       forward_chain(prepared, touch.joints).tip_in_block_m());
  }
  return distances;
}

Touch moved_onto_plane(const PreparedModel& model, const Plane& contact_plane, const Touch& touch) {
  Touch moved = touch;
  for (int step = 0; step < kMoveStepsMax; ++step) {
    const Chain chain = forward_chain(model, moved.joints);
    const double distance = signed_distance_m(contact_plane, chain.tip_in_block_m());
    if (std::abs(distance) < kOnPlaneMetres) break;
    const Eigen::Matrix<double, 1, kJointCount> slope =
        contact_plane.outward.transpose() * tip_jacobian(model.model, chain);
    const double squared = slope.squaredNorm();
    if (squared < 1e-12) break;  // no joint moves the tip along the normal here
    moved.joints -= slope.transpose() * (distance / squared);
    if (std::abs(distance) < kLastStepMetres) break;
  }
  return moved;
}

Touch moved_onto_plane(const KinematicModel& model, const Plane& contact_plane, const Touch& touch) {
  return moved_onto_plane(prepare(model), contact_plane, touch);
}

}  // namespace calib
