#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib_core/identification/identify.hpp"

namespace bench {

/// One iteration: the identified columns of W (n x 25), scaled to unit norm, their norms, and the residuals.
struct Equations {
  Eigen::MatrixXd scaled;
  Eigen::VectorXd norms;
  Eigen::VectorXd output_error;
};

/// The matrices that one identification factorises.
struct Matrices {
  Eigen::MatrixXd choice;  // n x 37: nominal arm, each touch on its nominal face
  std::vector<Equations> iterations;
};

/// Of eq. 15 iterated as often as `result` did, with its columns.
Matrices matrices_of(const calib::KinematicModel& nominal,
                     const std::vector<calib::ContactSurface>& contact_planes,
                     std::vector<calib::Touch> touches, const calib::IdentificationResult& result);

/// The linear algebra that an identification cannot do without, as fast as Eigen has it: the QR of the
/// choice; in each iteration a QR with the step, and from its R both condition numbers (eq. 16); at the end
/// one covariance. Returns a sum over all of it, so that the compiler leaves nothing out.
double factorise(const Matrices& matrices);

}  // namespace bench
