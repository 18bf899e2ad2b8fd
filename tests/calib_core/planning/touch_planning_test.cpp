#include "calib_core/planning/touch_planning.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/swept_collision.hpp"
#include "calib_core/numerics/condition_number.hpp"
#include "calib_core/observability/identifiability.hpp"
#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/transfer_planning.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr int kFitPerFace = 25;
constexpr int kHeldOutPerFace = 10;

struct PlannedCell {
  PlanningProblem problem;
  TouchPlan plan;
  std::vector<PlannedTouch> unaimed;  // the plan's touches as an arm makes them of which nothing is known
  double condition_number_max = 0.0;
};

std::vector<ContactSurface> contact_planes(const PlanningProblem& problem) {
  std::vector<ContactSurface> planes;
  for (const Face& face : problem.faces) planes.push_back(contact_plane(face, problem.stylus));
  return planes;
}

PlanningProblem problem_of(double ball_radius_m, double tilt_max_deg, int face_count) {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {.radius_m = ball_radius_m},
                          .scene = tx90::scene(ball_radius_m),
                          .park_joints = tx90::park_joints(),
                          .tilt_max_rad = radians_from_degrees(tilt_max_deg),
                          .candidate_count = 4000,
                          .identification = {.identifiability = {.tried_last = paper::tried_last()}},
                          .workspace_box = {"in front", {-0.3, -0.5, -0.25}, {0.3, 0.0, 0.55}}};
  problem.goal.fit_count = face_count * kFitPerFace;
  problem.knowledge.nominal = problem.nominal;
  problem.knowledge.artefact = exact_artefact(contact_planes(problem));
  problem.knowledge.touch_noise_m = 20e-6;
  problem.knowledge.tolerances.fill(1e-3);
  for (int face = 0; face < face_count; ++face) {
    problem.requests.push_back({face, kFitPerFace, kFitPerFace, kHeldOutPerFace});
  }
  return problem;
}

PlannedCell planned(PlanningProblem problem, double condition_number_max) {
  auto plan = plan_touches(problem);
  if (const auto* failure = std::get_if<PlanningFailure>(&plan)) throw std::runtime_error(failure->reason);
  PlannedCell cell{problem, std::get<TouchPlan>(std::move(plan)), {}, condition_number_max};
  for (const PlannedTouch& touch : cell.plan.touches)
    cell.unaimed.push_back(std::get<AimedTouch>(nominal_touch(problem, touch)).touch);
  return cell;
}

/// The paper's cell: the tip is the contact point, tilts to 45 degrees.
const PlannedCell& edf() {
  static const PlannedCell cell = planned(problem_of(0.0, 45, 4), 160);
  return cell;
}

/// A 3 mm ball, tilts to 70 degrees, the plate as a fifth face.
const PlannedCell& demo() {
  static const PlannedCell cell = planned(problem_of(0.003, 70, 5), 80);
  return cell;
}

class EveryPlan : public testing::TestWithParam<const PlannedCell& (*)()> {
 protected:
  const PlanningProblem& problem_ = GetParam()().problem;
  const std::vector<PlannedTouch>& touches_ = GetParam()().plan.touches;
  const std::vector<PlannedTouch>& unaimed_ = GetParam()().unaimed;
  const double condition_number_max_ = GetParam()().condition_number_max;

  [[nodiscard]] const Face& face_of(const PlannedTouch& touch) const {
    return problem_.faces[static_cast<std::size_t>(touch.face)];
  }

  [[nodiscard]] std::size_t fit_count() const { return problem_.requests.size() * kFitPerFace; }

  /// W of the first touches and its identifiable columns.
  [[nodiscard]] Eigen::MatrixXd identifiable_columns(std::size_t count) const {
    const std::vector<ContactSurface> planes = contact_planes(problem_);
    std::vector<Touch> made;
    for (std::size_t i = 0; i < count; ++i) made.push_back({touches_[i].face, touches_[i].joints});
    const Eigen::MatrixXd matrix =
        observe(problem_.nominal, planes, made, Formulation::kSignedDistance).matrix;
    return select_columns(matrix, choose_identifiable(matrix, {.tried_last = paper::tried_last()}).columns);
  }
};

INSTANTIATE_TEST_SUITE_P(TouchPlanning, EveryPlan, testing::Values(&edf, &demo),
                         [](const auto& each) { return each.index == 0 ? "edf" : "demo"; });

TEST_P(EveryPlan, InterleavesTheFacesAndFitsBeforeItHoldsOut) {
  ASSERT_EQ(touches_.size(), problem_.requests.size() * (kFitPerFace + kHeldOutPerFace));
  std::map<std::pair<int, TouchRole>, int> counts;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    EXPECT_EQ(touches_[i].role, i < fit_count() ? TouchRole::kFit : TouchRole::kHeldOut);
    if (i > 0) {
      EXPECT_NE(touches_[i].face, touches_[i - 1].face) << i;
    }
    ++counts[{touches_[i].face, touches_[i].role}];
  }
  for (const TouchRequest& request : problem_.requests) {
    EXPECT_EQ((counts[{request.face, TouchRole::kFit}]), kFitPerFace);
    EXPECT_EQ((counts[{request.face, TouchRole::kHeldOut}]), kHeldOutPerFace);
  }
}

TEST_P(EveryPlan, BeginsWithTheNominalMissAndEndsWithASmallOne) {
  EXPECT_EQ(touches_.front().predicted_position_error_m, problem_.nominal_position_error_m);
  EXPECT_LT(touches_.back().predicted_position_error_m, 0.25 * problem_.nominal_position_error_m);
  for (const PlannedTouch& touch : touches_)
    EXPECT_LE(touch.predicted_position_error_m, problem_.nominal_position_error_m);
}

TEST_P(EveryPlan, StatesEachWayAndItsTime) {
  PlanningProblem problem = problem_;
  JointVector standing = problem_.park_joints;
  double sum_s = GetParam()().plan.park_s;
  for (const PlannedTouch& touch : touches_) {
    std::vector<JointVector> way{standing};
    way.insert(way.end(), touch.via.begin(), touch.via.end());
    way.push_back(touch.clear_joints);
    EXPECT_LE(touch.via.size(), kTransferPosturesMax);
    EXPECT_NEAR(touch.travel_s, path_time_s(prepare(problem.nominal), problem.motion, way), 1e-9);
    // The touch before may have had the smaller miss: both keep at least the least possible one.
    for (std::size_t leg = 1; leg < way.size(); ++leg) {
      EXPECT_FALSE(find_clash_on_move(travel_scene(problem), problem.nominal, way[leg - 1], way[leg],
                                      kPredictedPositionErrorMinMetres - kSweptErrorMaxMetres));
    }
    standing = touch.clear_joints;
    sum_s += touch.travel_s + touch.touch_s;
  }
  EXPECT_NEAR(GetParam()().plan.duration_s(), sum_s, 1e-6);
}

TEST_P(EveryPlan, StaysInTheJointRanges) {
  for (const PlannedTouch& touch : touches_) {
    for (const auto* joints :
         {&touch.joints, &touch.clear_joints, &touch.approach_joints, &touch.search_end_joints}) {
      EXPECT_TRUE(problem_.joint_ranges.contains(*joints));
    }
  }
}

TEST_P(EveryPlan, TouchesTheFaceOnAStraightLineAlongItsNormal) {
  for (const PlannedTouch& touch : touches_) {
    const bool is_aimed = touch.predicted_position_error_m < problem_.nominal_position_error_m;
    const double standoff_m = std::max(touch.predicted_position_error_m + 0.003, is_aimed ? 0.005 : 0.015);
    const Face& face = face_of(touch);
    const Eigen::Isometry3d contact = forward_kinematics(problem_.nominal, touch.joints);
    EXPECT_NEAR(signed_distance_m(contact_plane(face, problem_.stylus), contact.translation()), 0.0, 1e-9);
    EXPECT_NEAR(std::acos(-contact.linear().col(2).dot(face.plane.outward)), touch.tilt_rad, 1e-7);
    EXPECT_LE(touch.tilt_rad, problem_.tilt_max_rad);
    EXPECT_EQ(touch.search_direction, -face.plane.outward);
    EXPECT_DOUBLE_EQ(touch.search_length_m, 2.0 * standoff_m);
    const Eigen::Isometry3d clear = forward_kinematics(problem_.nominal, touch.clear_joints);
    EXPECT_LT((clear.linear() - contact.linear()).norm(), 1e-8);
    EXPECT_GE(face.plane.outward.dot(clear.translation() - contact.translation()),
              standoff_m + kSlowZoneMetres - 1e-9);
    EXPECT_LT((touch.clear_joints - touch.joints).cwiseAbs().maxCoeff(), 0.6) << "another branch";
    for (const auto& [joints, height_m] :
         {std::pair(touch.approach_joints, standoff_m), std::pair(touch.search_end_joints, -standoff_m)}) {
      Eigen::Isometry3d expected = contact;
      expected.pretranslate(height_m * face.plane.outward);
      EXPECT_LT((forward_kinematics(problem_.nominal, joints).matrix() - expected.matrix()).norm(), 1e-8);
      EXPECT_LT((joints - touch.joints).cwiseAbs().maxCoeff(), 0.6) << "another branch";
    }
  }
}

TEST_P(EveryPlan, KeepsTheArmClearFromTheClearPostureToTheContact) {
  CollisionScene arm = problem_.scene;
  std::erase_if(arm.bodies, [](const Capsule& body) { return body.frame == 7; });
  for (const PlannedTouch& touch : unaimed_) {
    EXPECT_FALSE(find_clash(problem_.scene, forward_chain(problem_.nominal, touch.clear_joints),
                            problem_.nominal_position_error_m));
    for (const auto& [from, to] : {std::pair(touch.clear_joints, touch.approach_joints),
                                   std::pair(touch.approach_joints, touch.joints)}) {
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Chain chain = forward_chain(problem_.nominal, from + share * (to - from));
        EXPECT_FALSE(find_clash(arm, chain, problem_.nominal_position_error_m - 1e-4));
      }
    }
  }
}

TEST_P(EveryPlan, AnArmThatMissesAsInTheTableMeetsItsFaceAndNothingElse) {
  const KinematicModel truth = apply(problem_.nominal, paper::table3());
  CollisionScene all_but_ball = problem_.scene;
  std::erase_if(all_but_ball.bodies, [](const Capsule& body) { return body.name == "ball"; });
  for (const PlannedTouch& touch : unaimed_) {
    const ContactSurface plane = contact_plane(face_of(touch), problem_.stylus);
    Eigen::Isometry3d pose = forward_kinematics(problem_.nominal, touch.approach_joints);
    JointVector joints = touch.approach_joints;
    double height_m = 1.0;
    constexpr double kStepMetres = 2.5e-4;
    for (double gone_m = 0.0; gone_m <= touch.search_length_m; gone_m += kStepMetres) {
      const Chain chain = forward_chain(truth, joints);
      ASSERT_FALSE(find_clash(all_but_ball, chain, 0.0));
      height_m = signed_distance_m(plane, chain.tip_in_block_m());
      ASSERT_TRUE(gone_m > 0.0 || height_m > 0.0) << "on the face before the search began";
      if (height_m <= 0.0) break;
      pose.pretranslate(kStepMetres * touch.search_direction);
      joints = solve_near(problem_.nominal, pose, joints).value();
    }
    EXPECT_LE(height_m, 0.0) << "the search ended before the face";
  }
}

TEST_P(EveryPlan, ShowsAllIdentifiableParametersWithAGoodConditionNumber) {
  const Eigen::MatrixXd columns = identifiable_columns(fit_count());
  EXPECT_EQ(columns.cols(), 25);
  EXPECT_LT(condition_number(columns), condition_number_max_);
  RecordProperty("condition_number", std::to_string(condition_number(columns)));
}

TEST_P(EveryPlan, ShowsThemAfterLittleMoreTouchesThanThereAreParameters) {
  EXPECT_EQ(identifiable_columns(28).cols(), 25);
  EXPECT_LT(condition_number(identifiable_columns(40)), 310);  // what method-notes says of interleaved planes
}

TEST_P(EveryPlan, HoldsOutTouchesThatAreSpreadAndNotAmongTheFitted) {
  // Quadrants of the part of a face that is touched: beside the plate the foot of the block is not.
  const auto place_on_face = [&](const PlannedTouch& touch) -> Eigen::Vector2d {
    const Face& face = face_of(touch);
    const Eigen::Vector3d place = forward_kinematics(problem_.nominal, touch.joints).translation();
    return {place.dot(face.edge_u), place.dot(face.edge_v())};
  };
  std::map<int, Eigen::AlignedBox2d> touched;
  for (const PlannedTouch& touch : touches_) touched[touch.face].extend(place_on_face(touch));
  std::map<int, std::set<int>> quadrants;
  for (std::size_t i = fit_count(); i < touches_.size(); ++i) {
    const Eigen::Vector2d off = place_on_face(touches_[i]) - touched[touches_[i].face].center();
    quadrants[touches_[i].face].insert((off.x() > 0 ? 1 : 0) + (off.y() > 0 ? 2 : 0));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((touches_[i].joints - touches_[j].joints).norm(), radians_from_degrees(2));
    }
  }
  for (const auto& [face, reached] : quadrants) EXPECT_EQ(reached.size(), 4u) << "face " << face;
}

TEST_P(EveryPlan, HasAClearWayFromEachTouchToTheNextAlsoForAnArmThatMisses) {
  const KinematicModel truth = apply(problem_.nominal, paper::table3());
  std::vector<JointVector> stops{problem_.park_joints};
  for (const PlannedTouch& touch : unaimed_) stops.push_back(touch.clear_joints);
  stops.push_back(problem_.park_joints);
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const auto between = find_transfer(problem_, stops[i - 1], stops[i]);
    ASSERT_TRUE(between) << i;
    ASSERT_LE(between->size(), kTransferPosturesMax);
    std::vector<JointVector> way{stops[i - 1]};
    way.insert(way.end(), between->begin(), between->end());
    way.push_back(stops[i]);
    for (std::size_t leg = 1; leg < way.size(); ++leg) {
      EXPECT_TRUE(problem_.joint_ranges.contains(way[leg]));
      const JointVector move = way[leg] - way[leg - 1];
      const int steps = static_cast<int>(move.cwiseAbs().sum() * 1.3 / 0.005) + 1;  // 5 mm apart at most
      for (int step = 0; step <= steps; ++step) {
        const JointVector joints = way[leg - 1] + move * step / steps;
        ASSERT_FALSE(find_clash(problem_.scene, forward_chain(problem_.nominal, joints),
                                problem_.nominal_position_error_m - 1e-3));
        ASSERT_FALSE(find_clash(problem_.scene, forward_chain(truth, joints), 0.0));
      }
    }
  }
}

TEST_P(EveryPlan, TravelsOutsideTheSlowZone) {
  CollisionScene probe{.obstacles = problem_.scene.obstacles};
  for (const Capsule& body : travel_scene(problem_).bodies) {
    if (body.frame != kFrameCount - 1) continue;
    probe.bodies.push_back(body);
    probe.bodies.back().margin_m = 0.0;
  }
  for (const PlannedTouch& touch : unaimed_) {
    const auto between = find_transfer(problem_, problem_.park_joints, touch.clear_joints);
    ASSERT_TRUE(between);
    std::vector<JointVector> way{problem_.park_joints};
    way.insert(way.end(), between->begin(), between->end());
    way.push_back(touch.clear_joints);
    for (std::size_t leg = 1; leg < way.size(); ++leg) {
      EXPECT_FALSE(find_clash_on_move(probe, problem_.nominal, way[leg - 1], way[leg],
                                      problem_.nominal_position_error_m + kSlowZoneMetres));
    }
  }
}

TEST(TouchPlanning, AnyTouchCanFollowAnyOther) {
  const auto& touches = demo().unaimed;
  for (std::size_t i = 0; i < touches.size(); i += 7) {
    for (std::size_t j = 3; j < touches.size(); j += 11) {
      EXPECT_TRUE(find_transfer(demo().problem, touches[i].clear_joints, touches[j].clear_joints));
    }
  }
}

TEST(TouchPlanning, GivesTheSamePlanForTheSameSeedAndAnotherForAnother) {
  PlanningProblem problem = problem_of(0.0, 45, 4);
  problem.candidate_count = 1000;
  const auto joints_of = [](const PlanningProblem& asked) {
    std::vector<JointVector> joints;
    for (const PlannedTouch& touch : planned(asked, 0).plan.touches) joints.push_back(touch.joints);
    return joints;
  };
  const auto first = joints_of(problem);
  EXPECT_EQ(joints_of(problem), first);
  problem.seed = 2;
  EXPECT_NE(joints_of(problem), first);
}

PlanningFailure failure_of(const PlanningProblem& problem) {
  auto plan = plan_touches(problem);
  if (!std::holds_alternative<PlanningFailure>(plan)) throw std::runtime_error("there is a plan");
  return std::get<PlanningFailure>(std::move(plan));
}

TEST(TouchPlanning, SaysThatABlockIsOutOfReach) {
  PlanningProblem problem = problem_of(0.0, 45, 4);
  problem.nominal.links[1].d_m -= 1.0;
  const PlanningFailure failure = failure_of(problem);
  EXPECT_EQ(failure.face, 0);
  EXPECT_EQ(failure.found, 0);
  EXPECT_EQ(failure.wanted, kFitPerFace + kHeldOutPerFace);
  EXPECT_EQ(failure.reason, "out of reach");
}

TEST(TouchPlanning, SaysThatTheJointRangesStandInTheWay) {
  PlanningProblem problem = problem_of(0.0, 45, 4);
  problem.joint_ranges.upper[2] = 0.0;
  problem.joint_ranges.lower[2] = -0.1;
  EXPECT_EQ(failure_of(problem).reason, "joint ranges");
}

TEST(TouchPlanning, NamesTheBodyAndTheObstacleThatStandInTheWay) {
  PlanningProblem problem = problem_of(0.003, 70, 3);
  problem.requests = {{2, 5, 5, 0}};
  problem.goal.fit_count = 5;
  problem.scene.obstacles.push_back({"lid", {-0.1, -0.220, -0.1}, {0.1, -0.210, 0.1}});
  const PlanningFailure failure = failure_of(problem);
  EXPECT_EQ(failure.face, 2);
  EXPECT_EQ(failure.reason, "the tool holder is within 12 mm of the lid");
}

TEST(TouchPlanning, SaysThatTheParkPostureIsNotClear) {
  PlanningProblem problem = problem_of(0.0, 45, 4);
  problem.park_joints = tx90::degrees(0, 60, 90, 0, 0, 0);
  EXPECT_EQ(failure_of(problem).reason, "the forearm is too near the plate in the park posture");
}

TEST(TouchPlanning, RefusesAFaceThatDoesNotExist) {
  PlanningProblem problem = problem_of(0.0, 45, 4);
  problem.requests = {{5, 1, 1, 0}};
  EXPECT_THROW(plan_touches(problem), std::logic_error);
}

}  // namespace
}  // namespace calib
