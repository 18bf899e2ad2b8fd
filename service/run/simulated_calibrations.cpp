#include "service/run/simulated_calibrations.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace cell {
namespace {

constexpr int kDrawsAtATime = 16;

calib::MonteCarloPostures postures_of(const Cell& cell) {
  return {.box = calib::postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box,
                                        std::nullopt, kMonteCarloPostureCount),
          .joint_ranges = calib::postures_over_joint_ranges(cell.arm.joint_ranges, kMonteCarloPostureCount)};
}

/// Each draw has its place in the list, whoever makes it.
std::vector<calib::MonteCarloDraw> draw_all(const calib::MonteCarlo& simulation, int count, int threads,
                                            const DrawProgress& progress) {
  std::vector<calib::MonteCarloDraw> draws(static_cast<std::size_t>(count));
  std::atomic<int> next = 0;
  const auto work = [&](const DrawProgress& tell) {
    for (int first = next.fetch_add(kDrawsAtATime); first < count; first = next.fetch_add(kDrawsAtATime)) {
      const int end = std::min(count, first + kDrawsAtATime);
      for (int i = first; i < end; ++i)
        draws[static_cast<std::size_t>(i)] = simulation.draw(static_cast<std::uint64_t>(i));
      if (tell) tell(std::min(count, next.load()));
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([&work] { work({}); });
    work(progress);
  }
  return draws;
}

}  // namespace

std::optional<calib::MonteCarloFigures> simulate_calibrations(const TipRegions& regions,
                                                              const calib::IdentificationProblem& problem,
                                                              const calib::IdentificationOptions& options,
                                                              const calib::IdentificationResult& result,
                                                              int count, int threads,
                                                              const DrawProgress& progress) {
  if (!result.uncertainty) return std::nullopt;
  const calib::MonteCarlo simulation(problem, options, result, fitted_touches(problem, result),
                                     postures_of(regions.cell()));
  const std::vector<calib::MonteCarloDraw> draws = draw_all(simulation, count, threads, progress);
  const TipRegions::Regions& tip = regions.tip();
  const bool box_is_known = predicted_rms_m(tip.workspace_box, *result.uncertainty).has_value();
  calib::MonteCarloFigures figures =
      calib::figures_of(draws, box_is_known ? simulation.linear_box_rms_m() : std::nullopt);
  if (!predicted_rms_m(tip.joint_ranges, *result.uncertainty)) figures.joint_ranges_rms_m.reset();
  return figures;
}

std::optional<std::string> missing_draws(const std::optional<calib::MonteCarloFigures>& figures) {
  if (!figures)
    return "no Monte Carlo: the noise of a touch is neither declared nor measured by these touches";
  if (figures->box_rms_m) return std::nullopt;
  return "no Monte Carlo figure for the workspace box: the arm has no posture in it, or the draws did not "
         "converge";
}

}  // namespace cell
