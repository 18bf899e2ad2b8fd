#pragma once

#include <string>
#include <variant>
#include <vector>

#include "calib_core/proof/calibration_record.hpp"

/// Two calibrations of one arm: whether the arm has changed between them.
namespace calib {

/// Less likely differences are no chance.
inline constexpr double kComparisonP = 0.01;
/// U = 2 u in E_n, as in ISO 13528.
inline constexpr double kComparisonCoverage = 2.0;

/// One of the independent combinations of identified errors in which two calibrations can differ.
struct Combination {
  struct Share {
    int parameter = 0;   // index into ArmVector
    double share = 0.0;  // -1 to 1, of the errors in their standard deviations
  };
  std::vector<Share> shares;  // the largest first, as far as they count
  /// Later minus earlier, by the expanded uncertainty of this difference: beyond 1 it is more than chance
  /// explains of one combination.
  double e_n = 0.0;
};

/// The combinations of some errors, the most striking one first, and what all of them say together.
struct ComparedErrors {
  double chi_square = 0.0;
  double degrees_of_freedom = 0.0;
  double p = 1.0;  // by F, as the noise of each calibration has few degrees of freedom
  std::vector<Combination>
      combinations;  // empty: neither calibration nor chance says anything of these errors

  [[nodiscard]] bool has_changed() const { return p < kComparisonP; }
};

struct Comparison {
  double growth = 0.0;  // of the arm's lengths from the earlier to the later one, a share
  double std_growth = 0.0;
  ComparedErrors arm;   // beside the growth
  ComparedErrors tool;  // frame 7: the stylus was changed or bent
  /// Later minus earlier errors, growth among them, and their covariance; 0 of what is not compared.
  ArmVector difference = ArmVector::Zero();
  ArmCovariance covariance = no_covariance();
};

/// Why two calibrations cannot be compared: one sentence with the remedy.
struct ComparisonRefusal {
  std::string message;
};

/// Both of the same arm and block. Compared is what both estimated, not by parameter: the errors of
/// neighbours are correlated, and one of them alone says little. The covariance of the difference is that of
/// the noise of both, and of what displaces the two estimates differently because their postures differ; what
/// displaces them alike (the block's certificate, an error that was held) is not in it. The block's place is
/// left out, it may have been moved; and growth has no limits, it is the arm's warmth. Errors of gears that
/// repeat at the same postures count as noise: between calibrations at the same postures the test is more
/// cautious than it says.
std::variant<Comparison, ComparisonRefusal> compare(const CalibrationRecord& earlier,
                                                    const CalibrationRecord& later);

}  // namespace calib
