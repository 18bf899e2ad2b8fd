// What correcting a target costs on one core, in processor time, beside the forward kinematics that it is
// made of: 100,000 targets over the joint ranges of the demonstration's arm, which droops. Ends with 1 where
// a figure at the end of a line is missed.
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "calib_core/compensation/compensation.hpp"
#include "calib_core/numerics/halton.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"

namespace {

constexpr int kTargets = 100'000;
constexpr double kMicrosecondsMax = 20.0;
/// A correction takes four chains of the drooping arm and two of the nominal one, and four solutions of six
/// equations.
constexpr double kChainsMax = 20.0;

/// Processor time of one call for each target, microseconds.
template <class Work>
double microseconds_each(const std::vector<calib::JointVector>& postures, const Work& work) {
  const std::clock_t before = std::clock();
  for (const calib::JointVector& joints : postures) work(joints);
  return 1e6 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / kTargets;
}

bool tell(const char* what, double us, double chain_us) {
  const bool is_met = us <= kMicrosecondsMax && us <= kChainsMax * chain_us;
  std::printf("%-38s %6.2f us a target, %5.1f chains  (at most %g us, %g chains: %s)\n", what, us,
              us / chain_us, kMicrosecondsMax, kChainsMax, is_met ? "met" : "MISSED");
  return is_met;
}

}  // namespace

int main() {
  const std::filesystem::path folder = std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/demo";
  const cell::Cell cell = cell::read_cell(folder / "cell.json");
  calib::CompensationProblem problem{
      .nominal = cell.arm.model,
      .calibrated = cell::true_model(cell::read_truth(folder / "truth-real.json"), cell.arm),
      .joint_ranges = cell.arm.joint_ranges};
  std::vector<calib::JointVector> postures(kTargets);
  for (int i = 0; i < kTargets; ++i)
    postures[static_cast<std::size_t>(i)] = calib::halton_posture(i + 1, problem.joint_ranges);
  const calib::CompensationTool tool = calib::drawn_tool(cell.tools.at("gripper"));

  const calib::PreparedModel arm = calib::prepare(problem.calibrated);
  double sum_m = 0.0;
  const double chain_us = microseconds_each(postures, [&](const calib::JointVector& joints) {
    sum_m += calib::forward_chain(arm, joints).tip_in_block_m().x();
  });
  std::printf("forward kinematics with droop (the bound) %5.2f us  (mean tip at x = %.3f m)\n", chain_us,
              sum_m / kTargets);

  const calib::Compensation compensation(problem);
  int taken = 0;
  const auto count = [&taken](const calib::CompensatedTarget& target) { taken += target.joints ? 1 : 0; };
  bool all_met = tell(
      "joints",
      microseconds_each(
          postures, [&](const calib::JointVector& joints) { count(compensation.at_joints(tool, joints)); }),
      chain_us);
  all_met &= tell("poses",
                  microseconds_each(postures,
                                    [&](const calib::JointVector& joints) {
                                      const Eigen::Isometry3d pose =
                                          compensation.nominal_world_from_tool(tool, joints);
                                      count(compensation.at_pose(tool, pose, joints));
                                    }),
                  chain_us);
  std::printf("of twice %d targets %d are taken, the others are near a singular posture or out of range\n",
              kTargets, taken);

  problem.covariance = calib::no_covariance();
  problem.covariance->diagonal().setConstant(1e-10);
  const calib::Compensation with_uncertainty(problem);
  const double uncertain_us = microseconds_each(
      postures, [&](const calib::JointVector& joints) { count(with_uncertainty.at_joints(tool, joints)); });
  std::printf("%-38s %6.2f us a target  (at most %g us: %s)\n", "joints, with the tip's uncertainty",
              uncertain_us, kMicrosecondsMax, uncertain_us <= kMicrosecondsMax ? "met" : "MISSED");
  return all_met && uncertain_us <= kMicrosecondsMax ? 0 : 1;
}
