#pragma once

#include "calib_core/compensation/straight_line.hpp"
#include "calib_core/geometry/units.hpp"

namespace cell {

/// Medians over 1,000 targets of the demo cell's workspace box, true errors and droop, an uncorrected arm
/// 1.77 mm off (computed; reference use-and-plant.md, section 1). They say how large an error is, not which
/// one an arm has.

/// Of a point that a program moves on by `appro` or `compose` from a filtered one, a millimetre of distance.
inline constexpr double kCarriedErrorUmPerMm = 3.7;
/// Of a point moved on by so many millimetres, which are not negative. Micrometres.
double carried_error_um(double distance_mm);

/// How far the middle of a straight line between filtered ends is off that line. Micrometres.
struct LineDeviation {
  double median_um = 0.0;
  double one_in_twenty_um = 0.0;  // exceeded by one line in twenty
};
/// Grows about as the square of the length; both are 0 at 0.
LineDeviation line_deviation(double length_mm);
/// Points of a straight line between filtered ends are to be at most so far apart, and how far a line may be
/// off. A line of that length holds it in 95 of 100.
inline constexpr double kStraightLineMaxMm = calib::mm_from_metres(calib::kStraightLinePartMetres);
inline constexpr double kLineDeviationMaxMm = calib::mm_from_metres(calib::kLineDeviationMaxMetres);
/// How many points that takes between the ends.
int points_between(double length_mm);

}  // namespace cell
