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

}  // namespace

std::vector<TouchPattern> touch_patterns(const IdentificationProblem& problem) {
  std::vector<TouchPattern> patterns;
  if (has_lag(problem)) {
    for (const double std_rad : problem.gear_lag_std_rad) patterns.push_back({"backlash", std_rad});
  }
  for (const Eigen::Index k : uncertain_shapes(problem))
    patterns.push_back({k == 0 ? "pretravel_tilt" : "lobes", problem.artefact.std_sideways_m[k]});
  return patterns;
}

Eigen::MatrixXd pattern_displacements(const IdentificationProblem& problem, const LeastSquares& fit,
                                      const Estimate& estimate) {
  const KinematicModel arm = apply(problem.nominal, estimate.arm);
  const PreparedModel prepared = prepare(arm);
  const std::vector<Eigen::Index> shapes = uncertain_shapes(problem);
  const Eigen::Index first_shape = has_lag(problem) ? kJointCount : 0;
  Eigen::MatrixXd displaced = Eigen::MatrixXd::Zero(fit.rows().rows(), first_shape + std::ssize(shapes));
  for (std::size_t i = 0; i < fit.touches().size(); ++i) {
    if (!fit.kept()[i]) continue;
    const Touch& touch = problem.touches[fit.touches()[i]];
    const ContactSurface& surface = problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)];
    const Chain chain = forward_chain(prepared, touch.joints);
    const Eigen::Vector3d outward = normal_at(surface, chain.block_from_frame.back());
    const auto row = static_cast<Eigen::Index>(i);
    if (first_shape > 0) {
      // The joint stands behind the recorded position of its drive.
      const JointVector directions = search_directions(arm, chain, outward);
      for (int joint = 0; joint < kJointCount; ++joint) {
        const double gain = problem.nominal.gains[static_cast<std::size_t>(joint)];  // position to angle
        displaced(row, joint) = -directions[joint] * gain * fit.rows()(row, theta_index(joint));
      }
    }
    if (shapes.empty()) continue;
    const Eigen::Vector3d push = chain.block_from_frame.back().linear().transpose() * outward;
    displaced.row(row).segment(first_shape, std::ssize(shapes)) =
        fit.weights()[row] * sideways_shapes(push)(shapes).transpose();
  }
  return displaced;
}

}  // namespace calib
