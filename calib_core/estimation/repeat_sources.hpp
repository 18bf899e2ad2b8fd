#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib_core/estimation/pure_error.hpp"
#include "calib_core/geometry/touch.hpp"

/// Pure error from the three things that a run touches more than once, and from a qualification before it.
/// Heights run along the face's outward normal, of the ball by the nominal arm: what the nominal arm is wrong
/// by is the same in all touches of one posture and falls out of their differences.
///
/// 1. The touches of the reference place (`reference_touches`). Each is made anew, with its way and its
///    approach. Their scatter about the line of the drift is all that a touch at one posture scatters by:
///    the trigger, the stop of the arm, the encoders' step.
/// 2. A touch that was made again on a suspicion and agreed (`touched_again`). Made anew as well; without a
///    systematic difference the variance of a touch is the mean of (again - first)^2 / 2, one degree of
///    freedom a pair. Those that are suspected stand out from the others, so that these pairs are rather too
///    large: they count beside reference touches only where an F test does not tell them apart. A first touch
///    that was replaced as an outlier is a mistake and no noise.
/// 3. The two contacts of a two-speed touch (`two_speed`). On face f
///
///        second - first = c_f + e_2 - e_1
///
///    c_f is constant: the latch's delay times the difference of the speeds, and pre-travel that depends on
///    the speed. It is of the face, since the probe's pre-travel depends on the direction of the push. The
///    scatter about the mean of each face has the variance var_1 + var_2, twice that of a touch when both
///    contacts are as good as each other; its degrees of freedom are the touches less the faces. A first
///    contact that a knock set off early is what the second is made for: pairs that stand out by five robust
///    standard deviations do not count. One of them in a hundred would hide any misfit of the model.
///    It is a lower bound. Both contacts end one approach: how exactly the arm came to its stop before the
///    search, its play, its gears and where on the face it touches are the same in both and fall out.
///    (In the simulated cell, where trigger and stop are drawn once a touch, what is left is the step of
///    latch and encoders, a tenth of the noise.) So it never makes the noise smaller than touches that were
///    made anew say: see pure_error_of().
/// 4. The touches of one place in a qualification of the probe before the run (`qualified`). They are made
///    anew and of one posture like reference touches, but on another day: they count beside what the run
///    itself made anew where an F test does not tell them apart, with no more degrees of freedom than that
///    has, and alone where it made nothing anew.
namespace calib {

/// Two contacts of one place in one posture.
struct ContactPair {
  int face = 0;
  JointVector first = JointVector::Zero();
  JointVector second = JointVector::Zero();
};

/// What a run touched more than once.
struct Repeats {
  /// In the order of their making; those on one face are of one place in one posture.
  std::vector<Touch> references;
  std::vector<double> reference_times_s;  // of each of them, not decreasing; empty: not known of all
  std::vector<ContactPair> two_speed;
  std::vector<ContactPair> touched_again;  // both were believed
  std::optional<TouchNoise> qualified;     // of the repeats of a qualification before the run
};

/// Second height less first.
struct PairDifference {
  int face = 0;
  double difference_m = 0.0;
};

/// What one source says, and whether it is in the pure error.
struct RepeatSource {
  std::optional<TouchNoise> noise;
  bool used = false;
};

struct RepeatSources {
  RepeatSource reference_touches;
  RepeatSource two_speed;
  RepeatSource touched_again;
  RepeatSource qualification;
};

/// Noise of a touch, about the mean of each face, without the pairs that stand out. Nothing without a face
/// that has two pairs, and where no pair differs from another: these are copies.
std::optional<TouchNoise> two_speed_noise(std::span<const PairDifference> pairs);

/// Noise of a touch, about zero. Nothing without a pair, or where none differs.
std::optional<TouchNoise> touched_again_noise(std::span<const PairDifference> pairs);

/// The level of the F tests in pure_error_of().
inline constexpr double kPoolingLevel = 0.05;

/// The pure error of a run, from touches made anew (the reference touches, those made again and those of a
/// qualification) and the contacts of two-speed touches:
/// - where an F test shows both alike, both, by their degrees of freedom. Alike is not "not told apart": with
///   three reference touches nothing is told apart, and a hundred pairs that see a tenth of the noise would
///   outvote them. The test must refute at kPoolingLevel that touches made anew have twice the noise;
/// - where the pairs scatter significantly more, the pairs: the few touches made anew agreed by chance;
/// - else touches made anew alone, with their own degrees of freedom.
/// Pairs alone, a lower bound, say something only when they are above the declared noise. Notes in the
/// sources which were used. `declared_m`: 0 is unknown.
std::optional<TouchNoise> pure_error_of(RepeatSources& sources, double declared_m);

}  // namespace calib
