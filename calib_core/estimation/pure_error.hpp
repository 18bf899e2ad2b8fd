#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib_core/geometry/touch.hpp"

/// The noise of a touch from what was touched more than once (pure error): no model has a part in it.
namespace calib {

/// Noise of a touch and how well it is known.
struct TouchNoise {
  double std_m = 0.0;
  double degrees_of_freedom = 0.0;
};

/// The line through readings that were made one after the other.
struct ReadingLine {
  double slope = 0.0;  // per reading
  double variance_of_slope = 0.0;
  TouchNoise scatter;  // about the line
};

/// The fewest readings of one place that say something of their scatter.
inline constexpr std::size_t kReadingCountMin = 3;

/// The touches of one place that count as made one by one, in their order. An encoder's step lets a few have
/// the same joints. Where more than half of them repeat another's they are copies, which
/// would make any noise look small and well known: then each counts once.
std::vector<Touch> counted_readings(std::span<const Touch> at_place);

/// Nothing for fewer than kReadingCountMin. `readings_m`: distances of one place in the order of their
/// making.
std::optional<ReadingLine> line_through(std::span<const double> readings_m);

/// Both together, weighted by their degrees of freedom; one without any says nothing.
TouchNoise pooled(const TouchNoise& first, const TouchNoise& second);

}  // namespace calib
