#include "calib_core/uncertainty/touch_patterns.hpp"

#include "calib_core/uncertainty/left_out_effects.hpp"

namespace calib {
namespace {

bool has_lag(const IdentificationProblem& problem) { return !problem.gear_lag_std_rad.isZero(0.0); }

/// The shapes of the pre-travel that have a deviation.
std::vector<Eigen::Index> uncertain_shapes(const IdentificationProblem& problem) {
  std::vector<Eigen::Index> shapes;
  for (Eigen::Index k = 0; k < problem.artefact.std_sideways_m.size(); ++k) {
    if (problem.artefact.std_sideways_m[k] > 0.0) shapes.push_back(k);
  }
  return shapes;
}

/// The joints with harmonics of their transmission.
std::vector<int> uneven_joints(const IdentificationProblem& problem) {
  std::vector<int> joints;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const bool turns = problem.nominal.joint_types[static_cast<std::size_t>(joint)] == JointType::kRevolute;
    if (turns &&
        problem.nongeometric_std[static_cast<std::size_t>(harmonic_position(joint))].value_or(0.0) > 0.0)
      joints.push_back(joint);
  }
  return joints;
}

}  // namespace

CosSin twice_a_turn(const CosSin& turned) {
  return {turned.cos * turned.cos - turned.sin * turned.sin, 2.0 * turned.cos * turned.sin};
}

std::vector<TouchPattern> touch_patterns(const IdentificationProblem& problem) {
  std::vector<TouchPattern> patterns;
  if (has_lag(problem)) {
    for (const double std_rad : problem.gear_lag_std_rad) patterns.push_back({"backlash", std_rad});
  }
  for (const Eigen::Index k : uncertain_shapes(problem))
    patterns.push_back({k == 0 ? "pretravel_tilt" : "lobes", problem.artefact.std_sideways_m[k]});
  for (const int joint : uneven_joints(problem)) {
    const double std = *problem.nongeometric_std[static_cast<std::size_t>(harmonic_position(joint))];
    patterns.insert(patterns.end(), 2, {"gear_harmonics", std, joint});
  }
  return patterns;
}

Eigen::MatrixXd pattern_displacements(const IdentificationProblem& problem, const LeastSquares& fit,
                                      const Estimate& estimate) {
  const KinematicModel arm = apply(problem.nominal, estimate.arm);
  const PreparedModel prepared = prepare(arm);
  const std::vector<Eigen::Index> shapes = uncertain_shapes(problem);
  const std::vector<int> uneven = uneven_joints(problem);
  const Eigen::Index first_shape = has_lag(problem) ? kJointCount : 0;
  const Eigen::Index first_harmonic = first_shape + std::ssize(shapes);
  Eigen::MatrixXd displaced =
      Eigen::MatrixXd::Zero(fit.rows().rows(), first_harmonic + 2 * std::ssize(uneven));
  // Of a joint's position, which its gain turns into the angle.
  const auto per_rad = [&](int joint, Eigen::Index row) {
    return problem.nominal.gains[static_cast<std::size_t>(joint)] * fit.rows()(row, theta_index(joint));
  };
  for (std::size_t i = 0; i < fit.touches().size(); ++i) {
    if (!fit.kept()[i]) continue;
    const Touch& touch = problem.touches[fit.touches()[i]];
    const ContactSurface& surface = problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)];
    const Chain chain = forward_chain(prepared, touch.joints);
    const Eigen::Vector3d outward = normal_at(surface, chain.tip_in_block_m());
    const auto row = static_cast<Eigen::Index>(i);
    if (first_shape > 0) {
      // The joint stands behind the recorded position of its drive.
      const JointVector directions = search_directions(arm, chain, outward);
      for (int joint = 0; joint < kJointCount; ++joint)
        displaced(row, joint) = -directions[joint] * per_rad(joint, row);
    }
    for (Eigen::Index k = 0; k < std::ssize(uneven); ++k) {
      const int joint = uneven[static_cast<std::size_t>(k)];
      const CosSin phase = twice_a_turn(chain.turned[static_cast<std::size_t>(joint)]);
      displaced(row, first_harmonic + 2 * k) = phase.cos * per_rad(joint, row);
      displaced(row, first_harmonic + 2 * k + 1) = phase.sin * per_rad(joint, row);
    }
    if (shapes.empty()) continue;
    const Eigen::Vector3d push = chain.block_from_frame.back().linear().transpose() * outward;
    displaced.row(row).segment(first_shape, std::ssize(shapes)) =
        fit.weights()[row] * sideways_shapes(push)(shapes).transpose();
  }
  return displaced;
}

}  // namespace calib
