#pragma once

#include <nlohmann/json_fwd.hpp>

#include "calib_core/identification/identify.hpp"

/// The parts of a result document about parameters. Lengths are in mm, angles in rad.
namespace cell {

/// A candidate's value in its document unit: mm or rad.
double shown(int index, double value);

/// All 37 candidates. With a prior every one that is not excluded has an error and is `identified`;
/// `identifiable_count` is still the rank of the touches.
nlohmann::ordered_json parameters_json(const calib::IdentificationProblem& problem,
                                       const calib::IdentificationOptions& options,
                                       const calib::IdentificationResult& result);

/// The uncertain quantities of block, ball and probe. `identified`: the touches improve on the given value;
/// else `prior`.
nlohmann::ordered_json artefact_parameters_json(const calib::IdentificationProblem& problem,
                                                const calib::IdentificationResult& result);

/// The strongest correlations of identified errors.
nlohmann::ordered_json correlations_json(const calib::IdentificationResult& result);

/// The compliance of joints 2 and 3; empty when it was not estimated.
nlohmann::ordered_json stiffness_json(const calib::IdentificationOptions& options,
                                      const calib::IdentificationResult& result);

}  // namespace cell
