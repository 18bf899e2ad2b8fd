#pragma once

#include <vector>

#include "calib_core/identify.hpp"

namespace calib {

/// The contact planes as the identification found them: as written down but for the artefact's errors.
std::vector<Plane> estimated_planes(const Artefact& artefact, const Eigen::VectorXd& artefact_errors);

/// Validations B.3 and B.4 of the paper: a role and face at a time, in that order, without rejected touches.
std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const IdentificationResult& result);

}  // namespace calib
