#include "service/offline_programs/predicted_error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cell {
namespace {

struct CarriedFigure {
  double distance_mm, error_um;
};
constexpr CarriedFigure kCarriedFigures[] = {{0, 0}, {10, 38}, {20, 75}, {50, 185}, {100, 370}};

struct LineFigure {
  double length_mm, median_um, one_in_twenty_um;
};
constexpr LineFigure kLineFigures[] = {
    {20, 0.6, 5}, {50, 4, 20}, {100, 15, 65}, {200, 55, 164}, {400, 203, 464}};

/// By a power of the length through two figures.
double between(double length_mm, double a_mm, double a_um, double b_mm, double b_um) {
  const double power = std::log(b_um / a_um) / std::log(b_mm / a_mm);
  return a_um * std::pow(length_mm / a_mm, power);
}

}  // namespace

double carried_error_um(double distance_mm) {
  const auto* const above =
      std::ranges::upper_bound(kCarriedFigures, distance_mm, {}, &CarriedFigure::distance_mm);
  if (above == std::end(kCarriedFigures)) return kCarriedErrorUmPerMm * distance_mm;
  const auto* const below = std::prev(above);
  const double share = (distance_mm - below->distance_mm) / (above->distance_mm - below->distance_mm);
  return std::lerp(below->error_um, above->error_um, share);
}

LineDeviation line_deviation(double length_mm) {
  const auto* above = std::ranges::upper_bound(kLineFigures, length_mm, {}, &LineFigure::length_mm);
  // Outside of the figures: as the square of the length, from the nearest of them.
  if (above == std::begin(kLineFigures) || above == std::end(kLineFigures)) {
    const LineFigure& nearest =
        above == std::begin(kLineFigures) ? kLineFigures[0] : *std::prev(std::end(kLineFigures));
    const double square = length_mm * length_mm / (nearest.length_mm * nearest.length_mm);
    return {nearest.median_um * square, nearest.one_in_twenty_um * square};
  }
  const LineFigure& a = *std::prev(above);
  const LineFigure& b = *above;
  return {between(length_mm, a.length_mm, a.median_um, b.length_mm, b.median_um),
          between(length_mm, a.length_mm, a.one_in_twenty_um, b.length_mm, b.one_in_twenty_um)};
}

int points_between(double length_mm) {
  constexpr double kRounding = 1e-9;  // 100 mm are two parts of 50
  return std::max(0, static_cast<int>(std::ceil(length_mm / kStraightLineMaxMm - kRounding)) - 1);
}

}  // namespace cell
