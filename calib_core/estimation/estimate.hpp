#pragma once

#include <Eigen/Core>

#include "calib_core/kinematics/error_parameters.hpp"

namespace calib {

/// Current values of the unknowns: errors of the arm (0 where not estimated) and of the artefact.
struct Estimate {
  ArmVector arm = ArmVector::Zero();
  Eigen::VectorXd artefact;
};

}  // namespace calib
