#pragma once

#include <string>

#include "calib_core/validate.hpp"
#include "config/cell.hpp"

namespace cell {

/// touchcal/validation/1, one JSON document as text: the validations of the paper's section V.B of a
/// converged identification. `planes` is B.3, `planes_held_out` B.4, both as in a result document.
std::string validation_document(const Cell& cell, const Recipe& recipe,
                                const calib::IdentificationProblem& problem,
                                const calib::Validation& validation);

}  // namespace cell
