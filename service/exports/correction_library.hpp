#pragma once

#include <string>

#include "calib_core/compensation/compensation.hpp"

namespace cell {

/// What the VAL3 library touchcal_abs (cs8_protocol/val3/touchcal_abs) has to know of one arm to correct
/// points on its controller.
struct CorrectionLibrary {
  /// Nominal and calibrated arm, joint ranges. The covariance is not used: a controller says no uncertainty.
  calib::CompensationProblem arms;
  /// From the wrist's centre (R_6) to the flange, along z: what the controller calls `flange`.
  double wrist_to_flange_m = 0.0;
  std::string serial;   // as getVersion("ArmSN") says it; not empty
  std::string model;    // hash of what is applied
  std::string warmth;   // for people, at most 60 bytes: for which warmth of the arm the numbers hold
  int from = 0;         // day on which they are written: before it the controller's clock is wrong
  int valid_until = 0;  // last day on which they count, as 20270131; 0: no end
};

/// The library's data file `touchcal_abs.dtx` (VAL3 s7): lengths mm, angles degrees, masses kg. Throws
/// std::invalid_argument with the reason where the library cannot carry the arm: an oval gear or a ripple
/// (which no calibration identifies), a joint that slides, an arm on which joints 3 and 5 at 0 are not the
/// stretched elbow and the straight wrist, a text that VAL3 does not take.
std::string correction_library_data(const CorrectionLibrary& library);

}  // namespace cell
