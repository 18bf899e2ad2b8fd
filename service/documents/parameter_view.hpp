#pragma once

#include <vector>

#include "calib_core/identification/identify.hpp"
#include "service/documents/parameter_document.hpp"

/// The parts of a result document about parameters. Lengths are in mm, angles in rad.
namespace cell {

/// A candidate's value in its document unit: mm or rad.
double shown(int index, double value);

/// All 37 candidates. With a prior all that are not excluded have an error and are `identified`; the rank of
/// the touches is `identifiable_count` all the same.
std::vector<Parameter> parameters_of(const calib::IdentificationProblem& problem,
                                     const calib::IdentificationOptions& options,
                                     const calib::IdentificationResult& result);

/// What is not exactly known of block, ball and probe. `identified`: the touches say more of it than was
/// written down; else `prior`.
std::vector<ArtefactParameter> artefact_parameters_of(const calib::IdentificationProblem& problem,
                                                      const calib::IdentificationResult& result);

/// The strongest correlations of identified errors.
std::vector<CorrelationOfErrors> correlations_of(const calib::IdentificationResult& result);

/// The compliance of joints 2 and 3; empty when it was not estimated.
std::vector<JointCompliance> stiffness_of(const calib::IdentificationOptions& options,
                                          const calib::IdentificationResult& result);

}  // namespace cell
