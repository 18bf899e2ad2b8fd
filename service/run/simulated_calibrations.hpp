#pragma once

#include <functional>
#include <optional>
#include <string>

#include "calib_core/identification/monte_carlo.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// The tip is looked at in this many postures of the workspace box and of the joint ranges: the figures of a
/// draw are then good to a few per cent and cost no more than its identification.
inline constexpr int kMonteCarloPostureCount = 100;

/// Of a run's report, which the daemon makes: some ten seconds at most.
inline constexpr int kReportDrawsMin = 100;
inline constexpr int kReportDrawsMax = 10'000;

/// Told how many draws are done, on the calling thread and in between its own draws. With one thread it may
/// throw, which ends the simulation.
using DrawProgress = std::function<void(int done)>;

/// As many simulated calibrations as `count` says, on `threads` threads, the calling one among them; the
/// figures do not depend on their number. Nothing without an uncertainty: the noise of a touch is unknown.
/// Figures over a region where an error of unknown size matters are absent, as those of predicted_rms_m().
std::optional<calib::MonteCarloFigures> simulate_calibrations(const TipRegions& regions,
                                                              const calib::IdentificationProblem& problem,
                                                              const calib::IdentificationOptions& options,
                                                              const calib::IdentificationResult& result,
                                                              int count, int threads,
                                                              const DrawProgress& progress);

/// What is missing of the figures, in words; nothing where they are complete.
std::optional<std::string> missing_draws(const std::optional<calib::MonteCarloFigures>& figures);

}  // namespace cell
