// What planning costs on one core, in processor time: the closed form's rate beside that of the forward
// kinematics, the candidates, and whole plans of the demonstration's recipes. The figures at the end of a
// line are those that are wanted.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
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

calib::PlanningProblem without_compliance(calib::PlanningProblem problem) {
  problem.identification.stiffness = false;
  for (int joint = 0; joint < calib::kJointCount; ++joint)
    problem.knowledge.nongeometric_std[static_cast<std::size_t>(calib::compliance_position(joint))].reset();
  for (int frame = 1; frame <= calib::kMassCount; ++frame)
    problem.knowledge.nongeometric_std[static_cast<std::size_t>(calib::mass_position(frame))].reset();
  return problem;
}

/// Predicted tip uncertainty over the workspace box after the fitted touches of a plan, rms. NaN where it is
/// unknown.
double box_rms_mm(const calib::PlanningProblem& problem, const calib::TouchPlan& plan) {
  calib::IdentificationProblem knowledge = problem.knowledge;
  for (const calib::PlannedTouch& touch : plan.touches) {
    if (touch.role == calib::TouchRole::kFit)
      knowledge.touches.push_back({.face = touch.face, .joints = touch.joints});
  }
  calib::IdentificationOptions options = problem.identification;
  options.measure_noise = false;  // exact touches have none
  options.robust = false;
  options.harmonics = calib::Harmonics::kLeaveOut;
  const calib::IdentificationResult result = calib::identify(knowledge, options);
  if (!result.uncertainty) return std::numeric_limits<double>::quiet_NaN();
  return calib::mm_from_metres(
      calib::region_over_box(problem.nominal, problem.joint_ranges, problem.workspace_box)
          .rms_m(result.uncertainty->covariance())
          .value_or(std::numeric_limits<double>::quiet_NaN()));
}

/// What the geometry pays for touches that show the compliance as well, and what is had for it.
void price_of_compliance(const cell::Cell& cell, const std::string& recipe) {
  const calib::PlanningProblem problem = cell::planning_problem(cell, cell.recipes.at(recipe));
  const calib::PlanningProblem rigid = without_compliance(problem);
  const auto with = std::get<calib::TouchPlan>(calib::plan_touches(problem));
  const auto without = std::get<calib::TouchPlan>(calib::plan_touches(rigid));
  const double paid_mm = box_rms_mm(rigid, with), least_mm = box_rms_mm(rigid, without);
  std::printf(
      "%-4s %-6s tip in the box, geometry alone: %.4f mm where planned for it, %.4f mm where planned "
      "with compliance (%+.1f %%)\n",
      cell.name.c_str(), recipe.c_str(), least_mm, paid_mm, 100.0 * (paid_mm / least_mm - 1.0));
  std::printf("            with the compliance estimated: %.4f mm and %.4f mm\n",
              box_rms_mm(problem, without), box_rms_mm(problem, with));
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
  price_of_compliance(demo, "quick");
  price_of_compliance(demo, "best");
}
