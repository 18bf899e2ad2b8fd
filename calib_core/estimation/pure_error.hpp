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
  double slope = 0.0;  // per reading, or per second where their times are known
  double span = 0.0;   // from the first reading to the last, in the same unit
  double variance_of_slope = 0.0;
  TouchNoise scatter;  // about the line
};

/// The fewest readings of one place that say something of their scatter.
inline constexpr std::size_t kReadingCountMin = 3;

/// The touches of one place that count as made one by one, in their order. An encoder's step lets a few have
/// the same joints. Where more than half of them repeat another's they are copies, which
/// would make any noise look small and well known: then each counts once.
std::vector<Touch> counted_readings(std::span<const Touch> at_place);
/// The same by their index in `at_place`.
std::vector<std::size_t> counted_indices(std::span<const Touch> at_place);

/// Nothing for fewer than kReadingCountMin. `readings_m`: distances of one place in the order of their
/// making. `times_s`: of each of them, not decreasing; the line runs over the index where it is empty, or has
/// no span.
std::optional<ReadingLine> line_through(std::span<const double> readings_m,
                                        std::span<const double> times_s = {});

/// Half of the smallest repeatability (two sigma, 0.25 um) that makers of touch probes state: no touches of
/// an arm scatter less.
inline constexpr double kProbeScatterMinMetres = 0.125e-6;
/// Of what the maker's figures let the stops of the arm scatter: most of a stop is seen by the encoders.
inline constexpr double kStopScatterShareMin = 0.1;
/// Touches that really scatter by the least that is plausible are doubted this often.
inline constexpr double kScatterDoubtedP = 0.001;

/// Whether so small a scatter is no noise: touches that scatter by `least_m` show less in only
/// kScatterDoubtedP of runs. Readings of a place that was not touched hardly vary: those of another plane do
/// not follow the contact.
bool is_implausibly_small(const TouchNoise& scatter, double least_m);

/// Both together, weighted by their degrees of freedom; one without any says nothing.
TouchNoise pooled(const TouchNoise& first, const TouchNoise& second);

}  // namespace calib
