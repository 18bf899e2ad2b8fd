// A star stylus against one on the axis of joint 6: what becomes of another tool, which is not where the
// stylus is? A hundred seeds each of an arm that bends, warms up and has gears.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calib_core/geometry/units.hpp"
#include "config/touched_places.hpp"
#include "tests/figures/hidden_cell.hpp"
#include "tests/figures/simulated_cell.hpp"

namespace calib::figures {
namespace {

constexpr int kToolPostureCount = 200;
/// The centre of a welding gun, say, in R_6: its place there is found by touching, its way by the arm.
const Eigen::Vector3d kToolCentre(0.15, 0.0, 0.25);
/// Wanted of such a tool in the box.
constexpr double kToolMaxMetres = 0.06e-3;

struct Figures {
  std::vector<double> tool_m, tip_m, axis_rad;
  std::size_t identified = 0;

  void report(const char* what) const {
    std::printf(
        "star, %s, %zu seeds: %zu parameters, tip over the box %.3f mm, a tool 150 mm beside the axis of "
        "joint "
        "6 %.3f mm, direction of that axis %.2f mrad off\n",
        what, tip_m.size(), identified, mm_from_metres(median(tip_m)), mm_from_metres(median(tool_m)),
        1e3 * median(axis_rad));
  }
};

/// How far a tool is from where the identified arm has it, root mean square, when its centre in the
/// identified R_6 is the best there is: as one that was touched is known.
double tool_error_m(const KinematicModel& identified, const std::vector<JointVector>& postures,
                    const std::vector<Chain>& truth) {
  constexpr std::size_t kFlange = kJointCount;
  const PreparedModel model = prepare(identified);
  Eigen::MatrixXd rows(3 * std::ssize(postures), 3);
  Eigen::VectorXd off_m(rows.rows());
  for (std::size_t i = 0; i < postures.size(); ++i) {
    const Eigen::Isometry3d flange = forward_chain(model, postures[i]).block_from_frame[kFlange];
    const auto row = 3 * static_cast<Eigen::Index>(i);
    rows.middleRows<3>(row) = flange.linear();
    off_m.segment<3>(row) = truth[i].block_from_frame[kFlange] * kToolCentre - flange.translation();
  }
  const Eigen::Vector3d centre_m = rows.colPivHouseholderQr().solve(off_m);
  return std::sqrt((rows * centre_m - off_m).squaredNorm() / static_cast<double>(postures.size()));
}

/// The direction of axis 6 against the true one, root mean square; what the arm is turned by elsewhere
/// counts.
double axis_error_rad(const KinematicModel& identified, const std::vector<JointVector>& postures,
                      const std::vector<Chain>& truth) {
  const PreparedModel model = prepare(identified);
  double sum = 0.0;
  for (std::size_t i = 0; i < postures.size(); ++i) {
    const Chain chain = forward_chain(model, postures[i]);
    const Eigen::Vector3d is = truth[i].block_from_frame[kJointCount].linear().col(2);
    sum += (chain.block_from_frame[kJointCount].linear().col(2) - is).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(postures.size()));
}

Figures calibrate_star(const cell::Cell& cell, const cell::Recipe& recipe) {
  const std::vector<Touch> planned = all_planned_touches(cell, recipe);
  const HiddenArm arm{"truth-real", shipped_arm(shipped_cell("demo"), "truth-real").truth};
  const std::vector<JointVector> postures = postures_in_box(
      cell.arm.model, cell.arm.joint_ranges, cell.workspace_box, std::nullopt, kToolPostureCount);
  IdentificationProblem problem = cell::identification_problem(cell, recipe);
  Figures figures;
  for (int seed = 1; seed <= kSeedCount; ++seed) {
    UniformChance chance(static_cast<std::uint64_t>(seed));
    HiddenCell hidden(cell, arm, chance);
    hidden.touch_with_tips(cell, recipe, chance);
    make_run(hidden, planned, recipe, problem);
    const IdentificationResult result = identify(problem, recipe.identification);
    if (result.status != IdentificationStatus::kConverged) {
      ADD_FAILURE() << "seed " << seed << ": " << result.message;
      continue;
    }
    const std::vector<Chain> truth = hidden.chains(postures, hidden.mean_rise_k());
    figures.identified = result.identifiable.columns.size();
    figures.tool_m.push_back(tool_error_m(result.calibrated, postures, truth));
    figures.tip_m.push_back(
        tip_error_rms_m(result.calibrated, postures, hidden.tips_m(postures, hidden.mean_rise_k())));
    figures.axis_rad.push_back(axis_error_rad(result.calibrated, postures, truth));
  }
  return figures;
}

TEST(StarFigures, AnotherToolIsRightToo) {
  const cell::Cell cell = shipped_cell("star");
  const Figures one = calibrate_star(cell, cell.recipes.at("best"));
  one.report("100 touches with one tip");
  const Figures star = calibrate_star(cell, cell.recipes.at("star"));
  star.report("100 touches with the tips of a star");
  EXPECT_EQ(one.identified, 25u);
  EXPECT_EQ(star.identified, 27u);
  EXPECT_LE(median(star.tool_m), kToolMaxMetres);
  EXPECT_LE(4.0 * median(star.tool_m), median(one.tool_m));
  EXPECT_LE(8.0 * median(star.axis_rad), median(one.axis_rad));
}

}  // namespace
}  // namespace calib::figures
