#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "calib_core/proof/check.hpp"
#include "calib_core/proof/comparison.hpp"
#include "calib_core/proof/proof.hpp"
#include "tests/figures/hidden_cell.hpp"

/// Proofs and checks of arms that the identified model cannot represent exactly, each after a calibration of
/// the same hidden arm: what they see of faults, and how often they alarm of nothing.
namespace calib::figures {

/// How the arms of a study are calibrated.
struct StudiedCalibration {
  cell::Cell cell;
  cell::Recipe recipe;
  std::vector<Touch> planned;
};

/// The recipe of the demonstration cell with its plan. `with_stiffness`: the compliance of the joints is
/// estimated; harmonics are as the recipe says, or left out.
StudiedCalibration studied_calibration(const std::string& recipe, bool with_stiffness, Harmonics harmonics);

/// What the hidden arm has and the calibration left out.
enum class LeftOut { kNothing, kDroop, kEccentricGears };

struct ProofTally {
  int proofs = 0, seen = 0;             // seen: did not pass
  int by_chance = 0, by_rms = 0;        // of them: by the chi-square test, by the limit in mm
  int not_calibrated = 0, refused = 0;  // no proof
  std::string refusal;                  // the last one
  std::vector<double> p, rms_m, noise_m;
};

/// The block lifted 300 mm, touched 12 times by one plan for all seeds.
class ProofStudy {
 public:
  /// Plans with the calibration of the first seed of `arm`. Throws std::runtime_error when there is no plan.
  ProofStudy(StudiedCalibration calibration, const HiddenArm& arm);

  /// The same arm under this name; `left_out` is as large as makes the tip wrong by 0.1 mm over the box.
  [[nodiscard]] ProofTally tally(const HiddenArm& arm, LeftOut left_out, int seeds,
                                 std::uint64_t first_seed = 1) const;

  [[nodiscard]] const std::vector<ProofPower>& power() const { return power_; }
  [[nodiscard]] double plan_s() const { return plan_s_; }

 private:
  [[nodiscard]] HiddenArm with_fault(HiddenArm arm, LeftOut left_out, UniformChance& chance) const;
  [[nodiscard]] double worth_m(const Eigen::VectorXd& displacement) const;

  StudiedCalibration calibration_;
  cell::Cell lifted_;
  ProofPlace place_;
  TipRegion box_;
  std::vector<CalibrationRecord> planned_for_;  // one
  std::vector<Touch> touches_;
  std::vector<ProofPower> power_;
  double plan_s_ = 0.0;
};

/// What happened to a cell between its reference and a check.
struct CellFault {
  CheckCause cause = CheckCause::kNone;
  int joint = 0;      // of kJoint
  double size = 0.0;  // radians of a joint; metres of the stylus, and of the block, which is turned as well
};

struct CheckTally {
  int checks = 0, alarms = 0, named = 0;  // named: with the right cause
  std::vector<double> growth_error_ppm;
};

/// Twelve touches at the place of the calibration; three times the reference, then checks, the arm between 0
/// and 8 K warm at each.
class CheckStudy {
 public:
  CheckStudy(StudiedCalibration calibration, HiddenArm arm);

  [[nodiscard]] CheckTally tally(const CellFault& fault, int cells, int checks_each) const;
  /// The growth that one check of this seed's cell shows, `rise_k` warmer than cold, since a reference made
  /// while it was as warm as `reference_k`.
  [[nodiscard]] double growth_seen(const CalibrationRecord& record, std::uint64_t seed, double reference_k,
                                   double rise_k) const;
  [[nodiscard]] double plan_s() const { return plan_s_; }

 private:
  [[nodiscard]] CheckReference reference_at(const CalibrationRecord& record, std::uint64_t seed,
                                            std::span<const double> rises_k, std::uint64_t& scatter,
                                            UniformChance& chance) const;
  /// The touches of a check of a seed's cell, this much warmer than cold.
  [[nodiscard]] std::vector<Touch> touch(std::uint64_t seed, const CellFault& fault, double rise_k,
                                         std::uint64_t scatter, UniformChance& chance) const;

  StudiedCalibration calibration_;
  HiddenArm arm_;
  std::vector<Touch> touches_;
  double plan_s_ = 0.0;
};

struct ComparisonTally {
  int pairs = 0, arm_changed = 0, tool_changed = 0;
  std::vector<double> growth_error_ppm, arm_chi_square_per_degree;
};

/// Two calibrations of each seed's cell by the same plan, the arm between 0 and 8 K warm at each, with this
/// fault of a joint or the stylus in between.
ComparisonTally compare_calibrations(const StudiedCalibration& calibration, const HiddenArm& arm,
                                     const CellFault& fault, int pairs);

}  // namespace calib::figures
