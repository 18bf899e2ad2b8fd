#pragma once

#include <vector>

#include "calib_core/identify.hpp"

namespace calib {

/// Validations B.3 and B.4 of the paper: a role and face at a time, in that order, without rejected touches.
std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const IdentificationResult& result);

}  // namespace calib
