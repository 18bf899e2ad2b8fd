#include "calib_core/identification/held_places.hpp"

#include <algorithm>
#include <cstddef>

namespace calib {
namespace {

/// The centre of a ball that no fitted touch was made with.
void hold_untouched_tips(const IdentificationProblem& problem, IdentificationProblem& held) {
  for (ArtefactParameter& parameter : held.artefact.parameters) {
    if (parameter.kind != ArtefactKind::kTipCenter) continue;
    const bool is_touched = std::ranges::any_of(problem.touches, [&](const Touch& touch) {
      return touch.role == TouchRole::kFit &&
             !parameter.shifts[static_cast<std::size_t>(touch.face)].ball.isZero(0.0);
    });
    if (!is_touched) parameter.std = parameter.std.value_or(kFreeArtefactStd);
  }
}

}  // namespace

IdentificationProblem with_held_places(const IdentificationProblem& problem) {
  IdentificationProblem held = problem;
  for (const PlaceParameters& place : problem.artefact.places) {
    const bool is_touched = std::ranges::any_of(problem.touches, [&](const Touch& touch) {
      return touch.role == TouchRole::kFit &&
             problem.artefact.place_of(static_cast<std::size_t>(touch.face)) ==
                 static_cast<std::size_t>(place.place);
    });
    for (int k = place.first; !is_touched && k < place.first + kPlaceParameterCount; ++k) {
      auto& std = held.artefact.parameters[static_cast<std::size_t>(k)].std;
      std = std.value_or(kFreeArtefactStd);
    }
  }
  hold_untouched_tips(problem, held);
  return held;
}

}  // namespace calib
