#include "calib_core/proof/touch_rows.hpp"

#include <numeric>

#include "calib_core/estimation/block_registration.hpp"
#include "calib_core/uncertainty/touch_patterns.hpp"

namespace calib {

TouchRows touch_rows(const CalibrationRecord& record, const KinematicModel& arm,
                     std::span<const Touch> touches) {
  IdentificationProblem problem = record.problem();
  problem.nominal = arm;
  problem.touches.assign(touches.begin(), touches.end());
  for (Touch& touch : problem.touches) touch.role = TouchRole::kFit;
  std::vector<std::size_t> all(touches.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  LeastSquares fit(problem, record.options(), record.known_columns(), all);
  const Estimate estimate{ArmVector::Zero(), record.artefact_errors()};
  fit.linearise(estimate);
  const Eigen::VectorXd metres = fit.weights().cwiseInverse();

  const auto count = std::ssize(touches);
  const auto& columns = record.known_columns();
  TouchRows rows{.distances_m = fit.residuals_m(),
                 .of_arm = Eigen::MatrixXd::Zero(count, kArmParameterCount),
                 .of_joints = Eigen::MatrixXd(count, kJointCount),
                 .of_unknowns = Eigen::MatrixXd::Zero(count, record.unknown_count()),
                 .of_place = {}};
  for (std::size_t k = 0; k < columns.size(); ++k)
    rows.of_arm.col(columns[k]) = metres.asDiagonal() * fit.rows().col(static_cast<Eigen::Index>(k));
  for (int joint = 0; joint < kJointCount; ++joint)
    rows.of_joints.col(joint) =
        arm.gains[static_cast<std::size_t>(joint)] * rows.of_arm.col(theta_index(joint));
  rows.of_unknowns.leftCols<kArmParameterCount>() = rows.of_arm;
  const Eigen::Index artefact_count = record.artefact_errors().size();
  rows.of_unknowns.middleCols(kArmParameterCount, artefact_count) =
      metres.asDiagonal() * fit.rows().rightCols(artefact_count);
  if (const Eigen::Index patterns = record.unknown_count() - kArmParameterCount - artefact_count;
      patterns > 0)
    rows.of_unknowns.rightCols(patterns) =
        metres.asDiagonal() * pattern_displacements(problem, fit, estimate);
  std::vector<int> place;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (is_place_error(i)) place.push_back(i);
  }
  rows.of_place = rows.of_arm(Eigen::all, place);
  rows.of_unknowns(Eigen::all, place).setZero();
  return rows;
}

Eigen::VectorXd growth_effect(const CalibrationRecord& record, const Eigen::MatrixXd& of_arm) {
  return of_arm * errors_by_growth(record.calibrated(), 1.0);
}

Eigen::MatrixXd growth_covariance(const CalibrationRecord& record, double std_growth,
                                  const Eigen::MatrixXd& of_arm, const Eigen::MatrixXd& of_unknowns) {
  const Eigen::VectorXd since = std_growth * growth_effect(record, of_arm);
  const Eigen::VectorXd in_run = std_growth * (of_unknowns * record.displacement_by_growth());
  // An arm that grew by g since the middle of the calibration did a part u g of it by its end, and so by
  // 2 u g from its first touch to its last. Of u in (0, 1) nothing is known: E[(since + 2 u in_run)
  // (since + 2 u in_run)^T] is with E[u] = 1/2 and E[u^2] = 1/3 what follows.
  const Eigen::VectorXd both = since + in_run;
  return both * both.transpose() + in_run * in_run.transpose() / 3.0;
}

KinematicModel arm_at(const KinematicModel& calibrated, const Eigen::Isometry3d& calibrated_from_block) {
  KinematicModel there = calibrated;
  set_block_pose(there, calibrated_from_block.inverse() * block_pose_of(calibrated));
  return there;
}

}  // namespace calib
