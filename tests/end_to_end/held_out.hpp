#pragma once

#include <algorithm>
#include <cmath>

#include "calib_core/identification/identify.hpp"

namespace touchcal::testing {

/// What the held-out touches of a result say of the identified arm.
struct HeldOut {
  int touch_count = 0;
  double mean_max_m = 0.0;       // of the planes' |mean distance - reference|
  double rms_m = 0.0;            // over all held-out touches
  double rms_removed = 0.0;      // 1 - calibrated rms / nominal rms, over all held-out touches
  double rms_removed_min = 1.0;  // the least of the planes
  double plane_rms_max_m = 0.0;  // the largest of the planes, calibrated
};

inline HeldOut held_out(const calib::IdentificationResult& result) {
  HeldOut figures;
  double calibrated_squares = 0.0;
  double nominal_squares = 0.0;
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role != calib::TouchRole::kHeldOut) continue;
    figures.touch_count += face.touch_count;
    figures.mean_max_m = std::max(figures.mean_max_m, std::abs(face.calibrated_mean_m));
    figures.rms_removed_min =
        std::min(figures.rms_removed_min, 1.0 - face.calibrated_rms_m / face.nominal_rms_m);
    figures.plane_rms_max_m = std::max(figures.plane_rms_max_m, face.calibrated_rms_m);
    calibrated_squares += face.touch_count * face.calibrated_rms_m * face.calibrated_rms_m;
    nominal_squares += face.touch_count * face.nominal_rms_m * face.nominal_rms_m;
  }
  figures.rms_m = std::sqrt(calibrated_squares / figures.touch_count);
  figures.rms_removed = 1.0 - std::sqrt(calibrated_squares / nominal_squares);
  return figures;
}

}  // namespace touchcal::testing
