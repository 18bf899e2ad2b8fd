#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"

namespace cell {

/// The predicted tip error after further touches on one face.
struct TouchBenefit {
  int face = 0;
  int count = 0;
  double tip_rms_m = 0.0;  // with them

  bool operator==(const TouchBenefit&) const = default;
};

/// Number of further touches that faces are compared by.
inline constexpr int kBenefitTouchCount = 8;

/// The face whose kBenefitTouchCount further touches would lower the predicted tip error most. `candidates`
/// are postures on the nominal faces; those of a face are used cyclically. To first order, from the
/// information of rows and priors alone. `tip_rms_m` is the present prediction over the region. Nothing if
/// the result has not converged.
std::optional<TouchBenefit> most_beneficial_touches(const calib::IdentificationProblem& problem,
                                                    const calib::IdentificationOptions& options,
                                                    const calib::IdentificationResult& result,
                                                    const std::vector<calib::Touch>& candidates,
                                                    const calib::TipRegion& region, double tip_rms_m);

/// "8 more on plane 5: 0.21 to 0.15 mm".
std::string describe(const TouchBenefit& further, double tip_rms_m);

}  // namespace cell
