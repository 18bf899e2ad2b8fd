#include "calib_core/estimation/repeat_sources.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

/// A pair farther off than this many standard deviations is a blunder: of 200 good ones one falls out in
/// 9,000 runs.
constexpr double kBlunderStds = 5.0;
/// Of a normal variable: its standard deviation over its median absolute deviation.
constexpr double kStdOfMedianDeviation = 1.482602218505602;

/// A touch has half of the variance of a difference.
TouchNoise of_differences(double squares, double degrees) {
  return {std::sqrt(squares / degrees / 2.0), degrees};
}

/// P that chance makes the first variance so much larger than the second, when its true one is `times` that
/// of the second.
double chance_of(const TouchNoise& first, const TouchNoise& second, double times = 1.0) {
  if (first.std_m == 0.0) return 1.0;
  if (second.std_m == 0.0) return 0.0;
  const double ratio = std::pow(first.std_m / second.std_m, 2) / times;
  return f_survival(std::min(ratio, std::numeric_limits<double>::max()), first.degrees_of_freedom,
                    second.degrees_of_freedom);
}

/// Two-sided: neither is significantly larger.
bool are_not_told_apart(const TouchNoise& a, const TouchNoise& b) {
  return std::min(chance_of(a, b), chance_of(b, a)) >= kPoolingLevel / 2.0;
}

/// That touches made anew have twice the noise of the pairs is refuted.
bool are_shown_alike(const TouchNoise& anew, const TouchNoise& pairs) {
  constexpr double kTwiceTheNoise = 4.0;  // of the variance
  return are_not_told_apart(anew, pairs) && 1.0 - chance_of(anew, pairs, kTwiceTheNoise) < kPoolingLevel;
}

/// Without the pairs that stand out from the others of their face.
std::vector<PairDifference> without_blunders(std::span<const PairDifference> pairs) {
  std::map<int, std::vector<double>> faces;
  for (const PairDifference& pair : pairs) faces[pair.face].push_back(pair.difference_m);
  constexpr double kHalf = 0.5;
  std::map<int, double> middle_m;
  for (auto& [face, differences_m] : faces) middle_m[face] = sample_quantile(std::move(differences_m), kHalf);
  const auto off_m = [&](const PairDifference& pair) {
    return std::abs(pair.difference_m - middle_m.at(pair.face));
  };
  std::vector<double> all_off_m;
  for (const PairDifference& pair : pairs) all_off_m.push_back(off_m(pair));
  const double typical_m =
      pairs.empty() ? 0.0 : kStdOfMedianDeviation * sample_quantile(std::move(all_off_m), kHalf);
  std::vector<PairDifference> kept(pairs.begin(), pairs.end());
  // More than half are equal to the encoders' step: no size to measure the others by.
  if (typical_m == 0.0) return kept;
  std::erase_if(kept, [&](const PairDifference& pair) { return off_m(pair) > kBlunderStds * typical_m; });
  return kept;
}

/// Adds a source where it is not told apart from what there is.
void add_if_alike(RepeatSource& source, std::optional<TouchNoise>& noise) {
  source.used = source.noise && (!noise || are_not_told_apart(*noise, *source.noise));
  if (source.used) noise = noise ? pooled(*noise, *source.noise) : *source.noise;
}

/// Of the reference touches, then of those made again and of a qualification where these are not told apart
/// from what comes before.
std::optional<TouchNoise> made_anew(RepeatSources& sources) {
  std::optional<TouchNoise> noise;
  add_if_alike(sources.reference_touches, noise);
  add_if_alike(sources.touched_again, noise);
  // Of another day: it says no more than the run itself does.
  RepeatSource limited = sources.qualification;
  if (limited.noise && noise)
    limited.noise->degrees_of_freedom =
        std::min(limited.noise->degrees_of_freedom, noise->degrees_of_freedom);
  add_if_alike(limited, noise);
  sources.qualification.used = limited.used;
  return noise;
}

}  // namespace

std::optional<TouchNoise> two_speed_noise(std::span<const PairDifference> all_pairs) {
  const std::vector<PairDifference> pairs = without_blunders(all_pairs);
  struct OfFace {
    double sum = 0.0, count = 0.0;
  };
  std::map<int, OfFace> faces;
  for (const PairDifference& pair : pairs) {
    OfFace& face = faces[pair.face];
    face.sum += pair.difference_m;
    face.count += 1.0;
  }
  const double degrees = static_cast<double>(pairs.size()) - static_cast<double>(faces.size());
  double squares = 0.0;
  for (const PairDifference& pair : pairs) {
    const OfFace& face = faces[pair.face];
    squares += std::pow(pair.difference_m - face.sum / face.count, 2);
  }
  if (degrees < 1.0 || squares == 0.0) return std::nullopt;
  return of_differences(squares, degrees);
}

std::optional<TouchNoise> touched_again_noise(std::span<const PairDifference> pairs) {
  double squares = 0.0;
  for (const PairDifference& pair : pairs) squares += pair.difference_m * pair.difference_m;
  if (squares == 0.0) return std::nullopt;
  return of_differences(squares, static_cast<double>(pairs.size()));
}

std::optional<TouchNoise> pure_error_of(RepeatSources& sources, double declared_m) {
  const std::optional<TouchNoise> anew = made_anew(sources);
  const auto& pairs = sources.two_speed.noise;
  sources.two_speed.used = false;
  if (!pairs) return anew;
  if (!anew) {
    sources.two_speed.used = declared_m > 0.0 && pairs->std_m > declared_m;
    return sources.two_speed.used ? pairs : std::nullopt;
  }
  if (are_shown_alike(*anew, *pairs)) {
    sources.two_speed.used = true;
    return pooled(*anew, *pairs);
  }
  if (chance_of(*pairs, *anew) >= kPoolingLevel / 2.0) return anew;
  sources.reference_touches.used = sources.touched_again.used = sources.qualification.used = false;
  sources.two_speed.used = true;
  return pairs;
}

}  // namespace calib
