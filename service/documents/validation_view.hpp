#pragma once

#include <string>
#include <vector>

#include "calib_core/identification/validate.hpp"
#include "config/cell.hpp"
#include "service/documents/parameter_document.hpp"
#include "service/documents/validation_document.hpp"

namespace cell {

/// B.1 and B.2: `same_touches` and `other_touches`. `parameters`: those of the result document.
RepetitionsDocument repetitions_of(const std::vector<Parameter>& parameters,
                                   const calib::Validation& validation);

/// touchcal/validation/1: the validations of the paper's section V.B of a converged identification. `planes`
/// is B.3, `planes_held_out` B.4, both as in a result document.
ValidationDocument validation_of(const Cell& cell, const Recipe& recipe,
                                 const calib::IdentificationProblem& problem,
                                 const calib::Validation& validation);

/// The same as text.
std::string validation_document(const Cell& cell, const Recipe& recipe,
                                const calib::IdentificationProblem& problem,
                                const calib::Validation& validation);

}  // namespace cell
