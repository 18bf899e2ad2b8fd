#pragma once

#include <nlohmann/json_fwd.hpp>

#include "calib_core/identification/identify.hpp"

/// The parts of a result document that tell of parameters. Lengths are in mm, angles in rad.
namespace cell {

/// A candidate's value in the unit that documents show it in: mm or rad.
double shown(int index, double value);

/// All 37 candidates. With a prior all that are not excluded have an error and are `identified`; the rank of
/// the touches is `identifiable_count` all the same.
nlohmann::ordered_json parameters_json(const calib::IdentificationProblem& problem,
                                       const calib::IdentificationOptions& options,
                                       const calib::IdentificationResult& result);

/// What is not exactly known of block, ball and probe. `identified`: the touches say more of it than was
/// written down; else `prior`.
nlohmann::ordered_json artefact_parameters_json(const calib::IdentificationProblem& problem,
                                                const calib::IdentificationResult& result);

/// The strongest correlations of identified errors.
nlohmann::ordered_json correlations_json(const calib::IdentificationResult& result);

/// The compliance of joints 2 and 3; empty when it was not estimated.
nlohmann::ordered_json stiffness_json(const calib::IdentificationOptions& options,
                                      const calib::IdentificationResult& result);

}  // namespace cell
