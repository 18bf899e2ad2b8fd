#pragma once

#include "calib_core/identification/identify.hpp"

namespace bench {

struct DemoStudy {
  calib::IdentificationProblem problem;
  calib::IdentificationOptions options;
};

/// The cell `demo` with 100 fitted and 50 held-out touches of an arm and a place of the block drawn from what
/// its files say; noise of a touch as declared. Rigid: the candidates and the 18 quantities of the artefact.
/// Else with all that the recipe `best` takes on: compliance, harmonics that are tried, play that is left
/// out.
DemoStudy demo_study(bool rigid);

/// The unknowns of the result's fit.
int unknown_count(const calib::IdentificationResult& result);

}  // namespace bench
