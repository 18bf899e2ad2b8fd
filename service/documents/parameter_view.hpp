#pragma once

#include <vector>

#include "calib_core/identification/identify.hpp"
#include "service/documents/parameter_document.hpp"

/// The parts of a result document about parameters. Lengths are in mm, angles in rad.
namespace cell {

/// A candidate's value in its document unit: mm or rad.
double shown(int index, double value);

/// All 37 candidates. With a prior every one that is not excluded has an error and is `identified`;
/// `identifiable_count` is still the rank of the touches.
std::vector<Parameter> parameters_of(const calib::IdentificationProblem& problem,
                                     const calib::IdentificationOptions& options,
                                     const calib::IdentificationResult& result);

/// The uncertain quantities of block, ball and probe. `identified`: the touches improve on the given value;
/// else `prior`.
std::vector<ArtefactParameter> artefact_parameters_of(const calib::IdentificationProblem& problem,
                                                      const calib::IdentificationResult& result);

/// The strongest correlations of identified errors.
std::vector<CorrelationOfErrors> correlations_of(const calib::IdentificationResult& result);

/// What was estimated beside the candidates. `identified`: the touches improve on the maker's figure.
std::vector<NongeometricParameter> nongeometric_parameters_of(const calib::IdentificationProblem& problem,
                                                              const calib::IdentificationResult& result);

/// The compliances among them, as documents told them before nongeometric_parameters.
std::vector<JointCompliance> stiffness_of(const std::vector<NongeometricParameter>& parameters,
                                          const calib::IdentificationResult& result);

}  // namespace cell
