#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/identification/identification_result.hpp"

namespace calib {

/// Signed distances of one touch from the contact plane of its face, for the nominal and the calibrated
/// model. Metres.
struct TouchDistance {
  double nominal_m = 0.0;
  double calibrated_m = 0.0;
};

/// How far outwards of the written plane a face was found that is estimated in place, metres; nothing for any
/// other face and unless converged.
std::optional<double> found_offset_m(const IdentificationProblem& problem, const IdentificationResult& result,
                                     std::size_t face);

/// One per touch of the problem, including rejected and held-out touches: Figures 5 to 12 of the paper.
std::vector<TouchDistance> touch_distances(const IdentificationProblem& problem,
                                           const IdentificationResult& result);

/// The touches of this role and face, without rejected ones, as indices into those of the problem.
std::vector<std::size_t> touches_of(const IdentificationProblem& problem, const IdentificationResult& result,
                                    TouchRole role, int face);

/// Validations B.3 and B.4 of the paper: one per role and face, in that order, without rejected touches.
std::vector<FaceDistances> face_distances(const IdentificationProblem& problem,
                                          const IdentificationResult& result);

}  // namespace calib
