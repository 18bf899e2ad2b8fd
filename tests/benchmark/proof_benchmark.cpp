// What proofs, checks and comparisons of calibrations see of faults and how often they alarm of nothing, over
// so many simulated ones each (the first argument; 1,000). The second argument is the first seed of the
// proofs (1). The arms are those that the simulated controller hides: droop, gears, play, warming, scatter of
// the stops and a real probe, which the identified model has only in part. Ends with 1 where a figure is
// missed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/figures/proof_study.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace {

using namespace calib;
using namespace calib::figures;

constexpr int kSimulated = 1'000;
constexpr int kChecksEach = 10;
constexpr int kPairShare = 5;  // two calibrations take the longest
constexpr double kProofFalseMax = 0.015, kDroopSeenMin = 0.99, kGearsSeenMin = 0.85;
constexpr double kCheckFalseMax = 0.03, kOffsetNamedMin = 0.99;
constexpr double kSmallOffsetRad = 0.05e-3, kLargeOffsetRad = 0.3e-3, kFaultMetres = 0.1e-3;

double share(int part, int whole) {
  return whole == 0 ? std::nan("") : static_cast<double>(part) / static_cast<double>(whole);
}

const char* met(bool is_met) { return is_met ? "met" : "MISSED"; }

void tell_plan(const char* what, const ProofStudy& study) {
  std::printf("%s: %.0f s;", what, study.plan_s());
  for (const ProofPower& power : study.power())
    std::printf(" %s expected %.3f (noncentrality %.0f)", power.name.c_str(), power.power,
                power.noncentrality);
  std::printf("\n");
}

void tell_proofs(const char* what, const ProofTally& tally) {
  if (tally.proofs == 0) {
    std::printf("  %s: no proof, %d not calibrated, %d refused: %s\n", what, tally.not_calibrated,
                tally.refused, tally.refusal.c_str());
    return;
  }
  std::printf(
      "  %-32s %5d proofs: %5.1f %% failed (%.1f by chi-square, %.1f by mm); rms %.4f mm median, noise %.1f "
      "um; %d not calibrated, %d refused %s",
      what, tally.proofs, 100.0 * share(tally.seen, tally.proofs),
      100.0 * share(tally.by_chance, tally.proofs), 100.0 * share(tally.by_rms, tally.proofs),
      1e3 * median(tally.rms_m), 1e6 * median(tally.noise_m), tally.not_calibrated, tally.refused,
      tally.refusal.c_str());
}

/// What smaller levels of the test would give.
void tell_levels(const ProofTally& tally) {
  std::printf("    by chi-square at p <");
  for (const double level : {0.01, 0.005, 0.002, 0.001, 0.0005}) {
    const auto under = std::ranges::count_if(tally.p, [level](double p) { return p < level; });
    std::printf(" %g: %.1f %%", level, 100.0 * share(static_cast<int>(under), tally.proofs));
  }
  std::printf("\n");
}

bool at_most(double value, double limit) {
  std::printf("  (at most %g %%: %s)\n", 100.0 * limit, met(value <= limit));
  return value <= limit;
}

bool at_least(double value, double limit) {
  std::printf("  (at least %g %%: %s)\n", 100.0 * limit, met(value >= limit));
  return value >= limit;
}

bool tell_all_proofs(int count, std::uint64_t first_seed) {
  const HiddenArm real = shipped_arm(shipped_cell("demo"), "truth-real");
  bool all_met = true;
  {
    const ProofStudy study(studied_calibration("best", true, Harmonics::kLeaveOut), real);
    tell_plan("proof of an arm calibrated with its droop", study);
    const ProofTally nothing = study.tally(real, LeftOut::kNothing, count, first_seed);
    tell_proofs("nothing wrong", nothing);
    all_met &= at_most(share(nothing.seen, nothing.proofs), kProofFalseMax);
    tell_levels(nothing);
    const ProofTally gears = study.tally(real, LeftOut::kEccentricGears, count, first_seed);
    tell_proofs("eccentric gears worth 0.1 mm", gears);
    all_met &= at_least(share(gears.seen, gears.proofs), kGearsSeenMin);
    tell_levels(gears);
  }
  {
    const ProofStudy study(studied_calibration("best", false, Harmonics::kLeaveOut), real);
    tell_plan("proof of an arm calibrated without its droop", study);
    const ProofTally droop = study.tally(real, LeftOut::kDroop, count, first_seed);
    tell_proofs("a droop worth 0.1 mm", droop);
    all_met &= at_least(share(droop.seen, droop.proofs), kDroopSeenMin);
    tell_levels(droop);
  }
  return all_met;
}

CheckTally tell_checks(const CheckStudy& study, const char* what, const CellFault& fault, int count) {
  const CheckTally tally = study.tally(fault, std::max(1, count / kChecksEach), kChecksEach);
  std::printf("  %-32s %5d checks: %5.1f %% alarmed, %5.1f %% with the right cause", what, tally.checks,
              100.0 * share(tally.alarms, tally.checks), 100.0 * share(tally.named, tally.checks));
  return tally;
}

bool tell_all_checks(int count) {
  const HiddenArm real = shipped_arm(shipped_cell("demo"), "truth-real");
  const CheckStudy study(studied_calibration("best", true, Harmonics::kLeaveOut), real);
  std::printf("check: %.0f s; the arm 0 to 8 K warm at each\n", study.plan_s());
  const CheckTally nothing = tell_checks(study, "nothing wrong", {}, count);
  bool all_met = at_most(share(nothing.alarms, nothing.checks), kCheckFalseMax);
  std::printf("  growth is off by %.1f ppm rms\n", root_mean_square(nothing.growth_error_ppm));
  for (const int joint : kCheckedJoints) {
    for (const double size_rad : {kSmallOffsetRad, kCheckOffsetRadians, kLargeOffsetRad}) {
      char name[64];
      std::snprintf(name, sizeof name, "joint %d off by %.2f mrad", joint, 1e3 * size_rad);
      const CheckTally seen = tell_checks(study, name, {CheckCause::kJoint, joint, size_rad}, count);
      if (size_rad < kCheckOffsetRadians) {
        std::printf("\n");
      } else {
        all_met &= at_least(share(seen.named, seen.checks), kOffsetNamedMin);
      }
    }
  }
  tell_checks(study, "block moved 0.1 mm, 0.5 mrad", {CheckCause::kBlock, 0, kFaultMetres}, count);
  std::printf("\n");
  tell_checks(study, "stylus bent by 0.1 mm", {CheckCause::kStylus, 0, kFaultMetres}, count);
  std::printf("\n");
  return all_met;
}

bool tell_all_comparisons(int count) {
  const HiddenArm real = shipped_arm(shipped_cell("demo"), "truth-real");
  const StudiedCalibration best = studied_calibration("best", true, Harmonics::kLeaveOut);
  std::printf("two calibrations by one plan, the arm 0 to 8 K warm at each\n");
  const auto tell = [&](const char* what, const CellFault& fault) {
    const ComparisonTally tally = compare_calibrations(best, real, fault, std::max(1, count / kPairShare));
    std::printf("  %-32s %5d pairs: arm changed in %5.1f %%, stylus in %5.1f %%", what, tally.pairs,
                100.0 * share(tally.arm_changed, tally.pairs),
                100.0 * share(tally.tool_changed, tally.pairs));
    return tally;
  };
  const ComparisonTally nothing = tell("nothing wrong", {});
  const bool is_met =
      at_most(share(std::max(nothing.arm_changed, nothing.tool_changed), nothing.pairs), kCheckFalseMax);
  std::printf("  growth is off by %.1f ppm rms; chi-square of a degree of freedom %.2f in the median\n",
              root_mean_square(nothing.growth_error_ppm), median(nothing.arm_chi_square_per_degree));
  for (const int joint : {2, 3, 4, 5}) {
    for (const double size_rad : {kCheckOffsetRadians, kLargeOffsetRad}) {
      char name[64];
      std::snprintf(name, sizeof name, "joint %d off by %.2f mrad", joint, 1e3 * size_rad);
      tell(name, {CheckCause::kJoint, joint, size_rad});
      std::printf("\n");
    }
  }
  tell("stylus bent by 0.1 mm", {CheckCause::kStylus, 0, kFaultMetres});
  std::printf("\n");
  return is_met;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : kSimulated;
  const int first_seed = argc > 2 ? std::atoi(argv[2]) : 1;
  if (count < 1 || first_seed < 1) {
    std::fprintf(stderr,
                 "proof_benchmark [COUNT [SEED]]: how many proofs and checks of each, and the first seed of "
                 "the proofs; 1 or more\n");
    return 2;
  }
  const bool proofs_met = tell_all_proofs(count, static_cast<std::uint64_t>(first_seed));
  const bool checks_met = tell_all_checks(count);
  return tell_all_comparisons(count) && checks_met && proofs_met ? 0 : 1;
}
