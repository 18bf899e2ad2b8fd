#include "calib_core/proof/check_effects.hpp"

#include "calib_core/proof/check.hpp"

namespace calib {

CheckEffects check_effects(const CalibrationRecord& record, const TouchRows& rows) {
  CheckEffects effects;
  effects.of_growth = growth_effect(record, rows.of_arm);
  effects.of_joints.resize(rows.of_arm.rows(), std::ssize(kCheckedJoints));
  for (std::size_t k = 0; k < kCheckedJoints.size(); ++k)
    effects.of_joints.col(static_cast<Eigen::Index>(k)) = rows.of_arm.col(theta_index(kCheckedJoints[k] - 1));
  std::vector<int> tool;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (error_parameters()[static_cast<std::size_t>(i)].group() == ParameterGroup::kTool) tool.push_back(i);
  }
  effects.of_stylus = rows.of_arm(Eigen::all, tool);
  effects.of_block = rows.of_place;
  return effects;
}

}  // namespace calib
