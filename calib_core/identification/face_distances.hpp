#pragma once

#include <vector>

#include "calib_core/identification/identify.hpp"

namespace calib {

/// Of one touch, a signed distance of its face's contact plane each. Metres.
struct TouchDistance {
  double nominal_m = 0.0;
  double calibrated_m = 0.0;
};

/// One a touch of the problem, the rejected and the held-out ones among them: Figures 5 to 12 of the paper.
std::vector<TouchDistance> touch_distances(const IdentificationProblem& problem,
                                           const IdentificationResult& result);

/// Validations B.3 and B.4 of the paper: a role and face at a time, in that order, without rejected touches.
std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const IdentificationResult& result);

}  // namespace calib
