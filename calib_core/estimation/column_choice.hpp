#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"

namespace calib {

/// A parameter is held at nominal when the declared noise alone would give it a larger standard deviation,
/// estimated together with the previous columns while the later ones are known.
inline constexpr double kWeakLengthMetres = 1e-3;
inline constexpr double kWeakAngleRadians = 3e-3;

/// The limit for this parameter.
double weak_std(const ErrorParameter& parameter);

/// The parameters that well-distributed touches on all faces would determine, reachable or not.
IdentifiableSet attainable_set(const KinematicModel& nominal, const Artefact& artefact,
                               const IdentifiabilityOptions& options);

/// Their number, with the given tip and with a tip off the axis of the last joint.
Attainable attainable_parameters(const IdentificationProblem& problem, const IdentifiabilityOptions& options);

/// Chooses the identifiable columns on the nominal model, with each touch moved onto its nominal face.
/// `touches` are indices.
IdentifiableSet choose_columns(const IdentificationProblem& problem, const IdentificationOptions& options,
                               const std::vector<std::size_t>& touches);

/// The singular values, descending, of the matrix that choose_columns() decides on: W of the nominal model
/// with each touch moved onto its nominal face, without the excluded candidates and without what faces that
/// are estimated in place explain. As many as candidates (or touches): those beyond the identified ones are
/// rounding errors where the choice is clear.
std::vector<double> choice_singular_values(const IdentificationProblem& problem,
                                           const IdentificationOptions& options,
                                           const std::vector<std::size_t>& touches);

/// Indices into ArmVector of the estimated parameters: the chosen columns, or with the prior all that are not
/// excluded; with stiffness also the compliances of joints 1 to 3 that have a prior, with
/// Harmonics::kEstimate the harmonics that have one; or those that the options name. The compliances of the
/// wrist are never estimated: touches do not show them.
std::vector<int> estimated_columns(const IdentificationProblem& problem, const IdentificationOptions& options,
                                   const IdentifiableSet& chosen);

/// Why not more parameters are identifiable: the stylus, or the distribution of the touches. One or two
/// sentences.
std::string explain_rank(const IdentificationProblem& problem, const std::vector<std::size_t>& touches,
                         const IdentifiableSet& identifiable, const Attainable& attainable);

/// The largest angle between the z axis of the last frame and its mean, over the touches of a face; radians.
/// Nothing for a face without touches.
std::optional<double> tilt_spread_rad(const IdentificationProblem& problem,
                                      const std::vector<std::size_t>& touches, int face);

}  // namespace calib
