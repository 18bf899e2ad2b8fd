#pragma once

#include <optional>
#include <string>

namespace calib {

/// What determines the scale of the calibrated arm: one length of the block, two lengths of which both faces
/// each are touched and lie at a known distance, or the nominal arm with its tolerances.
enum class ScaleSource { kBlock, kTwoLengths, kPrior };

/// The common scale of all lengths, which revolute joints do not measure. A wrong ball radius, pre-travel,
/// block size or block temperature changes it without increasing the residuals.
struct ScaleCheck {
  ScaleSource source = ScaleSource::kBlock;
  double std_relative = 0.0;           // of the scale, from all sources of uncertainty
  double stretch_relative = 0.0;       // common change of all lengths, judged by the tolerances
  std::optional<double> significance;  // in standard deviations; nothing when no tolerance is known
  /// Deviation of the artefact parameter that the touches contradict most from its given value, in standard
  /// deviations; nothing where they show none, or where it follows from a scale that is warned of.
  std::optional<double> contradicted;
  std::string warning;  // with the likely causes; empty when there is none
};

/// Significance of a warning: one correct calibration in 196 exceeds it. With the tolerances of a TX90 a ball
/// radius error of 0.2 mm has a significance of 5.2; a limit of 3 would miss two in a hundred
/// (tests/figures/scale_test.cpp).
inline constexpr double kScaleSignificanceMax = 2.8;

/// The same for the deviation of one artefact parameter from its given value; there are about twenty.
inline constexpr double kArtefactSignificanceMax = 3.7;

struct IdentificationProblem;
struct IdentificationOptions;
struct FullLinearisation;
struct UncertaintyBudget;
struct Estimate;
class LeastSquares;

/// Tests a converged estimate for a common scale error of all lengths, next to errors within the maker's
/// tolerances (the block pose is free), and each artefact parameter for a deviation from its given value.
/// Score tests of the linearised maximum a posteriori problem.
ScaleCheck check_scale(const IdentificationProblem& problem, const IdentificationOptions& options,
                       const LeastSquares& fit, const FullLinearisation& whole,
                       const UncertaintyBudget& uncertainty, const Estimate& estimate);

}  // namespace calib
