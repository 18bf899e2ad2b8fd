#pragma once

#include "calib_core/identification/identification_result.hpp"

namespace calib {

/// Adds to the result of identify() what whoever reads it must know and no figure of it says: parameters that
/// were held, a droop that is in no uncertainty or that the residuals show, a declared noise that is too
/// large, drift, an unusual temperature, a face that fits no other, a wrong scale.
void add_warnings(const IdentificationProblem& problem, const IdentificationOptions& options,
                  IdentificationResult& result);

}  // namespace calib
