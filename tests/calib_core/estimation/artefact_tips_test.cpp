#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/estimation/input_check.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// A star stylus: further balls beside the one at the origin of R_7, each found by its touches.
namespace calib {
namespace {

constexpr std::size_t kTouchedFaces = 5;
constexpr std::size_t kTips = 3;
const Eigen::Vector3d kLeft(0.04, 0.0, -0.02), kBack(0.0, -0.04, -0.02);
constexpr double kSmallBallMetres = 0.002;

ArtefactKnowledge with_star() {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(kTouchedFaces);
  knowledge.tips = {{"left", kLeft, kSmallBallMetres, 5e-6}, {"back", kBack, kSmallBallMetres, 0.0}};
  return knowledge;
}

Eigen::Index index_in(const Artefact& artefact, const std::string& name) {
  const auto found = std::ranges::find(artefact.parameters, name, &ArtefactParameter::name);
  if (found == artefact.parameters.end()) throw std::logic_error("no parameter " + name);
  return found - artefact.parameters.begin();
}

Eigen::Isometry3d star_pose() {
  return Eigen::Translation3d(0.03, -0.2, 0.05) *
         Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized());
}

TEST(ArtefactTips, EachFaceIsTouchedByTheBallOfEachTip) {
  const Artefact one = make_artefact(drawn::uncertain_artefact(kTouchedFaces));
  const Artefact star = make_artefact(with_star());
  ASSERT_EQ(star.contact_planes.size(), kTips * kTouchedFaces);
  for (std::size_t face = 0; face < kTouchedFaces; ++face) {
    const Eigen::Isometry3d pose = star_pose();
    EXPECT_EQ(signed_distance_m(star.contact_planes[face], pose),
              signed_distance_m(one.contact_planes[face], pose));
    // n . P = offset + R - t with the ball's own centre and radius.
    const Eigen::Vector3d ball_m = pose * kLeft;
    const double bigger_m = kSmallBallMetres - with_star().stylus.radius_m;
    EXPECT_NEAR(signed_distance_m(star.contact_planes[kTouchedFaces + face], pose),
                signed_distance_m(one.contact_planes[face], ball_m) - bigger_m, 1e-15);
    EXPECT_EQ(star.tip_of(kTouchedFaces + face), 1u);
    EXPECT_EQ(star.tip_of(2 * kTouchedFaces + face), 2u);
    EXPECT_EQ(star.place_of(2 * kTouchedFaces + face), 0u);
  }
}

TEST(ArtefactTips, ItsSlopesAreThoseOfTheDistances) {
  const Artefact star = make_artefact(with_star());
  constexpr double kStep = 1e-6;
  const Eigen::Isometry3d pose = star_pose();
  for (std::size_t k = 0; k < star.parameters.size(); ++k) {
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(std::ssize(star.parameters));
    errors[static_cast<Eigen::Index>(k)] = kStep;
    std::vector<ContactSurface> planes;
    correct_contact_planes(star, errors, planes);
    for (std::size_t face = 0; face < planes.size(); ++face) {
      const ContactSurface& nominal = star.contact_planes[face];
      const double slope = (signed_distance_m(planes[face], pose) - signed_distance_m(nominal, pose)) / kStep;
      EXPECT_NEAR(star.parameters[k].shifts[face].at(contact_at(nominal, pose)), slope, 1e-6)
          << star.parameters[k].name << " plane " << face + 1;
    }
  }
}

TEST(ArtefactTips, OnlyTheFirstBallIsAsUncertainAsTheFirst) {
  const Artefact star = make_artefact(with_star());
  const auto& first = star.parameters[static_cast<std::size_t>(index_in(star, "stylus_radius"))];
  const auto& left = star.parameters[static_cast<std::size_t>(index_in(star, "tip_left_radius"))];
  EXPECT_EQ(first.shifts[0].constant, -1.0);
  EXPECT_EQ(first.shifts[kTouchedFaces].constant, 0.0);
  EXPECT_EQ(left.shifts[0].constant, 0.0);
  EXPECT_EQ(left.shifts[kTouchedFaces].constant, -1.0);
  EXPECT_EQ(left.std, 5e-6);
  EXPECT_EQ(parameters_without_prior(star).size(), 6u);
  EXPECT_FALSE(std::ranges::any_of(star.parameters, [](const ArtefactParameter& parameter) {
    return parameter.name == "tip_back_radius";
  }));
}

TEST(ArtefactTips, AtEachPlaceAllTipsTouch) {
  ArtefactKnowledge knowledge = with_star();
  knowledge.places = {{.name = "first"}, {.name = "stand", .std = PlaceDeviation{1e-5, 3e-5}}};
  knowledge.places[1].pose = star_pose();
  const Artefact both = make_artefact(knowledge), star = make_artefact(with_star());
  ASSERT_EQ(both.contact_planes.size(), 2 * kTips * kTouchedFaces);
  const Eigen::Isometry3d pose = Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.02, -0.03));
  const std::size_t back = 2 * kTouchedFaces + 3;  // face 4 with the tip "back"
  const std::size_t there = kTips * kTouchedFaces + back;
  EXPECT_EQ(both.place_of(there), 1u);
  EXPECT_EQ(both.tip_of(there), 2u);
  EXPECT_NEAR(signed_distance_m(both.contact_planes[there], star_pose() * pose),
              signed_distance_m(star.contact_planes[back], pose), 1e-15);
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(std::ssize(both.parameters));
  errors[index_in(both, "place_stand_x")] = 1e-4;
  std::vector<ContactSurface> planes;
  correct_contact_planes(both, errors, planes);
  EXPECT_NE(planes[there].offset_m, both.contact_planes[there].offset_m);
  EXPECT_EQ(planes[back].offset_m, both.contact_planes[back].offset_m);
}

TEST(ArtefactTips, OneFaceMayBeTouchedByAllTips) {
  const IdentificationProblem problem = drawn::problem(with_star());
  EXPECT_FALSE(find_invalid_input(problem, {}));
}

/// The ball of a tip has its pose by R_7: the sampled posture is moved until that ball is on the face.
std::vector<Touch> touches_with_all_tips(const IdentificationProblem& problem, const drawn::Truth& truth,
                                         UniformChance& chance) {
  const std::vector<Face> flat = drawn::certain_artefact(kTouchedFaces).faces;
  drawn::Manner manner{.count = 180};
  for (std::size_t tip = 0; tip < kTips; ++tip)
    manner.block.insert(manner.block.end(), flat.begin(), flat.end());
  for (int face = 0; face < static_cast<int>(problem.artefact.contact_planes.size()); ++face)
    manner.faces.push_back(face);
  return drawn::touches(truth, manner, chance);
}

/// A stylus on the axis of joint 6 shows 25 parameters; balls beside that axis show the direction of the axis
/// too, two more, wherever they are themselves.
TEST(ArtefactTips, TheTouchesFindTheBallsAndTheDirectionOfTheLastAxis) {
  IdentificationProblem problem = drawn::problem(with_star());
  UniformChance chance(11);
  Eigen::VectorXd artefact_errors = drawn::draw_artefact_errors(problem.artefact, chance);
  const Eigen::Index left = index_in(problem.artefact, "tip_left_x");
  const Eigen::Index back = index_in(problem.artefact, "tip_back_x");
  artefact_errors.segment<3>(left) = Eigen::Vector3d(0.0003, -0.0004, 0.0002);
  artefact_errors.segment<3>(back) = Eigen::Vector3d(-0.0002, 0.0001, 0.0004);
  EXPECT_EQ(attainable_parameters(drawn::problem(drawn::uncertain_artefact(kTouchedFaces)), {}).count, 25);
  EXPECT_EQ(attainable_parameters(problem, {}).count, 27);
  const IdentifiableSet identifiable = attainable_set(problem.nominal, problem.artefact, {});
  const drawn::Truth truth =
      drawn::truth_of(problem, drawn::errors_on(identifiable.columns, chance), artefact_errors);
  problem.touches = touches_with_all_tips(problem, truth, chance);
  const IdentificationResult result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 27u);
  for (const Eigen::Index tip : {left, back}) {
    const Eigen::Vector3d off = result.artefact_errors.segment<3>(tip) - artefact_errors.segment<3>(tip);
    const Eigen::Vector3d std = result.uncertainty->artefact_std.segment<3>(tip);
    EXPECT_LT(off.cwiseQuotient(std).cwiseAbs().maxCoeff(), 4.0);
    EXPECT_LT(std.norm(), 3e-4);
  }
  EXPECT_NEAR(result.iterations.back().residual_rms_m, study::kTouchNoiseMetres, 5e-6);
}

/// All touches of the tips before this one, and so many of its own.
std::vector<Touch> touches_up_to(const IdentificationProblem& problem, std::size_t last, int of_last) {
  std::vector<Touch> some;
  for (const Touch& touch : problem.touches) {
    const std::size_t tip = problem.artefact.tip_of(static_cast<std::size_t>(touch.face));
    if (tip < last || (tip == last && of_last-- > 0)) some.push_back(touch);
  }
  return some;
}

TEST(ArtefactTips, UntilItsTouchesFindItsBallATipIsHeldAndTheOthersHaveAResult) {
  IdentificationProblem problem = drawn::problem(with_star());
  UniformChance chance(12);
  const IdentifiableSet identifiable = attainable_set(problem.nominal, problem.artefact, {});
  const drawn::Truth truth = drawn::truth_of(problem, drawn::errors_on(identifiable.columns, chance),
                                             drawn::draw_artefact_errors(problem.artefact, chance));
  problem.attainable = attainable_parameters(problem, {});
  problem.touches = touches_with_all_tips(problem, truth, chance);
  IdentificationProblem begun = problem;
  for (const int of_back : {0, 1, 2}) {
    begun.touches = touches_up_to(problem, 2, of_back);
    const IdentificationResult result = identify(begun, {});
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    EXPECT_EQ(result.identifiable.columns.size(), 27u);
    EXPECT_EQ(result.artefact_errors[index_in(problem.artefact, "tip_back_z")], 0.0);
  }
  begun.touches = touches_up_to(problem, 1, 0);
  const IdentificationResult alone = identify(begun, {});
  EXPECT_EQ(alone.status, IdentificationStatus::kConverged) << alone.message;
  EXPECT_EQ(alone.identifiable.columns.size(), 25u);
}

}  // namespace
}  // namespace calib
