#pragma once

#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"

namespace calib {

/// A parameter is held when the declared noise alone would give it a larger standard deviation than this,
/// found along with those before it, those after it known: a guess, not a result.
inline constexpr double kWeakLengthMetres = 1e-3;
inline constexpr double kWeakAngleRadians = 3e-3;

/// What touches well spread over all faces, reachable or not, would show.
IdentifiableSet attainable_set(const KinematicModel& nominal, const Artefact& artefact,
                               const IdentifiabilityOptions& options);

/// How many that are, with the tip where it is and with a tip off the last joint's axis.
Attainable attainable_parameters(const IdentificationProblem& problem, const IdentifiabilityOptions& options);

/// The choice on the nominal model with each touch moved onto its nominal face. `touches` are indices.
IdentifiableSet choose_columns(const IdentificationProblem& problem, const IdentificationOptions& options,
                               const std::vector<std::size_t>& touches);

/// What is estimated, indices into ArmVector: the chosen columns, or with the prior all that are not
/// excluded; with stiffness the compliances too.
std::vector<int> estimated_columns(const IdentificationOptions& options, const IdentifiableSet& chosen);

/// Why not more is seen: the stylus, or what is wrong with the touches. One sentence or two.
std::string explain_rank(const IdentificationProblem& problem, const std::vector<std::size_t>& touches,
                         const IdentifiableSet& identifiable, const Attainable& attainable);

/// The largest angle between the last frame's z axis and the mean one, over the touches of a face; radians.
/// Nothing for a face without touches.
std::optional<double> tilt_spread_rad(const IdentificationProblem& problem,
                                      const std::vector<std::size_t>& touches, int face);

}  // namespace calib
