#pragma once

#include "calib_core/estimation/artefact.hpp"

/// One artefact touched with several tips and at several places: steps of make_artefact().
namespace calib {

/// The faces of the first tip become those of all; what is known of a face holds for each, but for the radius
/// of the first ball.
void spread_over_tips(const ArtefactKnowledge& knowledge, Artefact& artefact);

/// The faces of one place become those of all; what is known of a face holds at each. After the tips.
void spread_over_places(const ArtefactKnowledge& knowledge, Artefact& artefact);

/// Moves the faces of a place by the errors of its pose, as a rigid body.
void correct_place(const Artefact& artefact, const PlaceParameters& place, const Eigen::VectorXd& errors,
                   std::vector<ContactSurface>& planes);

}  // namespace calib
