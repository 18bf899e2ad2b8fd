#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calib_core/identification/validate.hpp"
#include "config/cell.hpp"

namespace cell {

/// B.1 and B.2: `same_touches` and `other_touches`. `parameters`: those of the result document.
nlohmann::ordered_json repetitions_json(const nlohmann::ordered_json& parameters,
                                        const calib::Validation& validation);

/// touchcal/validation/1, one JSON document as text: the validations of the paper's section V.B of a
/// converged identification. `planes` is B.3, `planes_held_out` B.4, both as in a result document.
std::string validation_document(const Cell& cell, const Recipe& recipe,
                                const calib::IdentificationProblem& problem,
                                const calib::Validation& validation);

}  // namespace cell
