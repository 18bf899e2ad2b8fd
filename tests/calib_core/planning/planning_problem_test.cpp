#include "calib_core/planning/planning_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <set>

#include "calib_core/kinematics/gravity.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "tests/calib_core/tx90.hpp"

/// A star stylus in a plan: what a tip touches is planned as if there were no other.
namespace calib {
namespace {

constexpr double kBallMetres = 0.003, kSmallBall = 0.002, kWithin = 0.002;
constexpr int kStarFaceCount = 4;
const Eigen::Vector3d kLeftBall(0.03, 0.0, -0.045), kBackBall(0.0, -0.03, -0.045);

void add_tip(PlanningProblem& problem, std::vector<ArtefactTip>& known, const std::string& name,
             const Eigen::Vector3d& ball_m) {
  const Eigen::Vector3d stem = Eigen::Vector3d(ball_m.x(), ball_m.y(), 0.0).normalized();
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), stem);
  const std::size_t body = problem.scene.bodies.size();
  problem.tips.push_back({Eigen::Translation3d(ball_m) * turn, kSmallBall, kWithin, {body, body + 1}});
  known.push_back({name, ball_m, kSmallBall, 0.0});
  problem.scene.bodies.push_back(
      {name + " ball", kFrameCount - 1, ball_m, ball_m, kSmallBall, kWithin, kWithin});
  problem.scene.bodies.push_back({name + " stem",
                                  kFrameCount - 1,
                                  {0.0, 0.0, ball_m.z()},
                                  ball_m - 0.003 * stem,
                                  0.001,
                                  kWithin,
                                  kWithin});
}

PlanningProblem cell_with_star() {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {.radius_m = kBallMetres},
                          .scene = tx90::scene(kBallMetres),
                          .park_joints = tx90::park_joints(),
                          .tilt_max_rad = radians_from_degrees(60.0),
                          .candidate_count = 3000,
                          .identification = {},
                          .workspace_box = {"in front", {-0.3, -0.5, -0.25}, {0.3, 0.0, 0.55}}};
  problem.nominal.masses[6] = {2.0, {0.01, 0.02, 0.1}};
  problem.nominal.masses[7] = {0.5, {0.002, -0.003, -0.1}};
  problem.scene.bodies.push_back({"plug", kFrameCount - 2, {0.05, 0.02, 0.0}, {0.06, 0.02, 0.03}, 0.01});
  problem.faces.resize(kStarFaceCount);
  ArtefactKnowledge knowledge{.faces = problem.faces, .stylus = problem.stylus};
  add_tip(problem, knowledge.tips, "left", kLeftBall);
  add_tip(problem, knowledge.tips, "back", kBackBall);
  const std::vector<Face> faces = problem.faces;
  for (std::size_t tip = 0; tip < problem.tips.size(); ++tip)
    problem.faces.insert(problem.faces.end(), faces.begin(), faces.end());
  problem.knowledge.nominal = problem.nominal;
  problem.knowledge.artefact = make_artefact(knowledge);
  problem.knowledge.touch_noise_m = 20e-6;
  problem.knowledge.tolerances.fill(1e-3);
  for (int face = 0; face < static_cast<int>(problem.faces.size()); ++face)
    problem.requests.push_back({face, 2, 40, 0});
  problem.goal.fit_count = 60;
  return problem;
}

std::vector<Eigen::Isometry3d> tip_poses(const PlanningProblem& problem) {
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 1; i <= 20; ++i)
    poses.push_back(forward_kinematics(problem.nominal, halton_posture(i, problem.joint_ranges)));
  return poses;
}

TEST(PlanningProblem, OfTheFirstTipIsTheProblemItself) {
  const PlanningProblem problem = cell_with_star();
  const PlanningProblem first = for_tip_of(problem, 2);
  EXPECT_EQ(first.nominal.links[7].r_m, problem.nominal.links[7].r_m);
  EXPECT_EQ(first.stylus.radius_m, kBallMetres);
  EXPECT_EQ(first.nominal_position_error_m, problem.nominal_position_error_m);
}

TEST(PlanningProblem, OfATipHasItsBallAtTheOriginAndItsStemAlongZ) {
  const PlanningProblem problem = cell_with_star();
  const PlanningProblem back = for_tip_of(problem, 2 * kStarFaceCount + 1);
  EXPECT_EQ(back.stylus.radius_m, kSmallBall);
  EXPECT_EQ(ball_position_error_m(problem, 2 * kStarFaceCount + 1), back.nominal_position_error_m);
  EXPECT_DOUBLE_EQ(back.nominal_position_error_m, problem.nominal_position_error_m + kWithin +
                                                      kOrientationErrorMaxRadians * kBackBall.norm());
  const std::vector<Eigen::Isometry3d> poses = tip_poses(problem), of_tip = tip_poses(back);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT((of_tip[i].translation() - poses[i] * kBackBall).norm(), 1e-12);
    EXPECT_LT((of_tip[i].linear().col(2) - poses[i].linear() * -Eigen::Vector3d::UnitY()).norm(), 1e-12);
  }
}

TEST(PlanningProblem, OfATipKeepsBodiesAndWeightsWhereTheyAre) {
  const PlanningProblem problem = cell_with_star();
  const PlanningProblem back = for_tip_of(problem, 2 * kStarFaceCount);
  const PreparedModel whole = prepare(problem.nominal), of_tip = prepare(back.nominal);
  for (int i = 1; i <= 20; ++i) {
    const JointVector joints = halton_posture(i, problem.joint_ranges);
    const Chain chain = forward_chain(whole, joints), there = forward_chain(of_tip, joints);
    for (std::size_t body = 0; body < problem.scene.bodies.size(); ++body) {
      const Segment axis = axis_in_block(problem.scene.bodies[body], chain);
      const Segment moved = axis_in_block(back.scene.bodies[body], there);
      EXPECT_LT((axis.from_m - moved.from_m).norm(), 1e-12) << problem.scene.bodies[body].name;
      EXPECT_LT((axis.to_m - moved.to_m).norm(), 1e-12) << problem.scene.bodies[body].name;
    }
    EXPECT_LT((gravity_torques_nm(whole, chain) - gravity_torques_nm(of_tip, there)).norm(), 1e-9);
  }
}

/// A ball in a posture, off everything that it could hit.
double off_obstacles_m(const PlanningProblem& problem, const Eigen::Vector3d& ball_m, double radius_m,
                       const JointVector& joints) {
  const Eigen::Vector3d here_m = forward_kinematics(problem.nominal, joints) * ball_m;
  double least_m = std::numeric_limits<double>::infinity();
  for (const Box& obstacle : problem.scene.obstacles)
    least_m = std::min(least_m, capsule_box_distance_m(here_m, here_m, radius_m, obstacle));
  return least_m;
}

/// A ball in a posture, over the plane of a face: its surface, not its centre.
double height_m(const PlanningProblem& problem, const Face& face, const Eigen::Vector3d& ball_m,
                double radius_m, const JointVector& joints) {
  return signed_distance_m(face.plane, forward_kinematics(problem.nominal, joints) * ball_m) - radius_m;
}

TEST(PlanningProblem, APlanTouchesEachFaceWithTheBallOfTheTipAndWithNoOther) {
  const PlanningProblem problem = cell_with_star();
  const auto planned = plan_touches(problem);
  if (const auto* failure = std::get_if<PlanningFailure>(&planned)) FAIL() << failure->reason;
  std::set<int> touched;
  for (const PlannedTouch& touch : std::get<TouchPlan>(planned).touches) {
    touched.insert(touch.face);
    const Face& face = problem.faces[static_cast<std::size_t>(touch.face)];
    const std::size_t own = problem.knowledge.artefact.tip_of(static_cast<std::size_t>(touch.face));
    EXPECT_NEAR(signed_distance_m(touched_surface(problem, touch.face),
                                  forward_kinematics(problem.nominal, touch.joints)),
                0.0, 1e-9);
    const std::vector<std::pair<Eigen::Vector3d, double>> balls{
        {Eigen::Vector3d::Zero(), kBallMetres}, {kLeftBall, kSmallBall}, {kBackBall, kSmallBall}};
    for (std::size_t ball = 0; ball < balls.size(); ++ball) {
      const auto& [center_m, radius_m] = balls[ball];
      if (ball != own) {
        // Both may be elsewhere, each by so much; the first one is where it is drawn.
        const double loose_m = own == 0 || ball == 0 ? kWithin : 2.0 * kWithin;
        EXPECT_GT(off_obstacles_m(problem, center_m, radius_m, touch.joints), loose_m + 0.001);
        continue;
      }
      EXPECT_NEAR(height_m(problem, face, center_m, radius_m, touch.joints), 0.0, 1e-9);
      EXPECT_NEAR(height_m(problem, face, center_m, radius_m, touch.approach_joints) +
                      height_m(problem, face, center_m, radius_m, touch.search_end_joints),
                  0.0, 1e-9);
    }
  }
  EXPECT_EQ(touched.size(), problem.faces.size());
}

}  // namespace
}  // namespace calib
