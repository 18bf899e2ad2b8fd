#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"

namespace cell {

/// What more touches on one face would make of the predicted tip error.
struct FurtherTouches {
  int face = 0;
  int count = 0;
  double tip_rms_m = 0.0;  // with them

  bool operator==(const FurtherTouches&) const = default;
};

/// So many touches are weighed against each other.
inline constexpr int kFurtherTouchCount = 8;

/// The face whose touches would lower the predicted tip error most, kFurtherTouchCount of them. `candidates`
/// are postures on the nominal faces; a face's are taken in turn, the first again after the last. From the
/// information of rows and priors alone, to first order. `tip_rms_m` is what is predicted now over the
/// region. Nothing when the result has not converged.
std::optional<FurtherTouches> best_further_touches(const calib::IdentificationProblem& problem,
                                                   const calib::IdentificationOptions& options,
                                                   const calib::IdentificationResult& result,
                                                   const std::vector<calib::Touch>& candidates,
                                                   const calib::TipRegion& region, double tip_rms_m);

/// "8 more on plane 5: 0.21 to 0.15 mm".
std::string describe(const FurtherTouches& further, double tip_rms_m);

}  // namespace cell
