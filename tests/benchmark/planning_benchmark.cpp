// What planning costs on one core, in processor time: the closed form's rate beside that of the forward
// kinematics, the candidates, and whole plans of the demonstration's recipes. The figures at the end of a
// line are those that are wanted.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/read_config.hpp"
#include "service/run/planning_problem.hpp"

namespace {

constexpr int kPoses = 100'000;
constexpr double kSolutionsMinPerSecond = 2e6;

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Processor time of one call.
template <class Work>
double seconds_of(const Work& work) {
  const double before_s = processor_s();
  work();
  return processor_s() - before_s;
}

std::vector<calib::JointVector> random_postures(const calib::JointRanges& ranges) {
  std::mt19937_64 chance(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<calib::JointVector> postures(kPoses);
  for (calib::JointVector& joints : postures) {
    for (int i = 0; i < calib::kJointCount; ++i) {
      joints[i] = ranges.lower[i] + share(chance) * (ranges.upper[i] - ranges.lower[i]);
    }
  }
  return postures;
}

/// Rates of poses of postures in range, one core. A solution is a branch that is in range as it comes, whole
/// turns not counted.
void kinematics_rates(const cell::Cell& cell) {
  const calib::PreparedModel prepared = calib::prepare(cell.arm.model);
  const calib::InverseKinematics inverse(cell.arm.model);
  const auto postures = random_postures(cell.arm.joint_ranges);
  std::vector<Eigen::Isometry3d> poses(postures.size());
  const double forward_s = seconds_of([&] {
    for (std::size_t i = 0; i < postures.size(); ++i) {
      poses[i] = calib::forward_chain(prepared, postures[i]).block_from_frame.back();
    }
  });
  long solutions = 0;
  const double inverse_s = seconds_of([&] {
    for (const Eigen::Isometry3d& pose : poses) {
      const calib::Postures found = inverse.solve(pose);
      for (const calib::JointVector& joints : found) solutions += cell.arm.joint_ranges.contains(joints);
    }
  });
  const double rate = static_cast<double>(solutions) / inverse_s;
  std::printf("forward kinematics (the bound)              %6.2f million a second\n",
              1e-6 * kPoses / forward_s);
  std::printf("inverse kinematics, solutions in range      %6.2f million a second  (at least %g: %s)\n",
              1e-6 * rate, 1e-6 * kSolutionsMinPerSecond, rate >= kSolutionsMinPerSecond ? "met" : "MISSED");
}

void candidate_rate(const cell::Cell& cell, const std::string& recipe) {
  const calib::PlanningProblem problem = cell::planning_problem(cell, cell.recipes.at(recipe));
  calib::CandidatePool pool;
  const double seconds = seconds_of([&] { pool = calib::find_candidates(problem); });
  std::printf("%-4s %-6s %6zu candidates                     %6.2f s\n", cell.name.c_str(), recipe.c_str(),
              pool.candidates.size(), seconds);
  for (const calib::FaceEffort& effort : pool.efforts) {
    std::printf("    plane %d: %6d of %7d tried (%4.1f %%)", effort.face + 1, effort.feasible, effort.tried,
                100.0 * effort.feasible / effort.tried);
    if (!effort.obstructions.empty()) std::printf("; most often: %s", effort.obstructions[0].reason.c_str());
    std::printf("\n");
  }
}

void plan_time(const cell::Cell& cell, const std::string& recipe, double limit_s) {
  if (!cell.recipes.contains(recipe)) return;
  const calib::PlanningProblem problem = cell::planning_problem(cell, cell.recipes.at(recipe));
  std::size_t touches = 0;
  const double seconds = seconds_of([&] {
    const auto plan = calib::plan_touches(problem);
    if (const auto* made = std::get_if<calib::TouchPlan>(&plan)) touches = made->touches.size();
  });
  std::printf("%-4s %-6s plan of %3zu touches                    %6.2f s  (at most %g: %s)\n",
              cell.name.c_str(), recipe.c_str(), touches, seconds, limit_s,
              touches > 0 && seconds <= limit_s ? "met" : "MISSED");
}

}  // namespace

int main() {
  const std::string cells = std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/";
  const cell::Cell edf = cell::read_cell(cells + "edf/cell.json");
  const cell::Cell demo = cell::read_cell(cells + "demo/cell.json");
  kinematics_rates(demo);
  candidate_rate(edf, "edf-25");
  candidate_rate(demo, "quick");
  plan_time(demo, "quick", 3.0);
  plan_time(demo, "best", 6.0);
}
