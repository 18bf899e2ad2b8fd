#pragma once

#include <optional>
#include <string>

namespace calib {

enum class ScaleSource { kBlock, kTwoLengths, kPrior };

/// The common stretch of all lengths, which revolute joints cannot see: a wrong ball, pre-travel, block size
/// or block temperature hides in it with perfect residuals.
struct ScaleCheck {
  ScaleSource source = ScaleSource::kBlock;
  double std_relative = 0.0;           // of the common stretch, from everything that is uncertain
  double stretch_relative = 0.0;       // by how much the lengths moved together, against the tolerances
  std::optional<double> significance;  // in standard deviations; nothing when no tolerance is known
  std::string warning;                 // with the suspects; empty when there is nothing to warn of
};

/// More standard deviations than this are a warning: one correct calibration in 196. A TX90's tolerances put
/// a ball that is wrong by 0.2 mm at 5.2 of them, so at 3 two in a hundred would not be seen
/// (tests/figures/scale_test.cpp).
inline constexpr double kScaleSignificanceMax = 2.8;

/// The same for one artefact parameter against what was written down; there are about twenty of them.
inline constexpr double kArtefactSignificanceMax = 3.7;

struct IdentificationProblem;
struct IdentificationOptions;
struct Linearisation;
struct Certainty;
struct Estimate;
class LeastSquares;

/// The guard at a converged estimate: a common stretch of all lengths is sought beside errors that keep to
/// the maker's tolerances (the block's place is free), and each artefact parameter is held against what the
/// touches say of it. Score tests of the linearised maximum a posteriori problem.
ScaleCheck check_scale(const IdentificationProblem& problem, const IdentificationOptions& options,
                       const LeastSquares& fit, const Linearisation& whole, const Certainty& certainty,
                       const Estimate& estimate);

}  // namespace calib
