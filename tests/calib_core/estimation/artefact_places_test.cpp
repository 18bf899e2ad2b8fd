#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/estimation/input_check.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// One artefact at two places: what is known of it holds at both, and the pose of the second is a parameter.
namespace calib {
namespace {

constexpr std::size_t kPlacedFaces = 5;

Eigen::Isometry3d lifted_and_turned() {
  return Eigen::Translation3d(0.05, -0.3, 0.1) *
         Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, -1).normalized());
}

ArtefactKnowledge at_two_places(std::optional<PlaceDeviation> std) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(kPlacedFaces);
  knowledge.places = {{.name = "first"}, {.name = "stand", .pose = lifted_and_turned(), .std = std}};
  return knowledge;
}

int index_of(const Artefact& artefact, const std::string& name) {
  for (std::size_t i = 0; i < artefact.parameters.size(); ++i)
    if (artefact.parameters[i].name == name) return static_cast<int>(i);
  throw std::logic_error("no parameter " + name);
}

TEST(ArtefactPlaces, EachFaceStandsAtEachPlace) {
  const Artefact one = make_artefact(drawn::uncertain_artefact(kPlacedFaces));
  const Artefact two = make_artefact(at_two_places(PlaceDeviation{1e-5, 3e-5}));
  ASSERT_EQ(two.contact_planes.size(), 2 * kPlacedFaces);
  const Eigen::Vector3d point_m(0.031, -0.087, 0.044);
  for (std::size_t face = 0; face < kPlacedFaces; ++face) {
    const double here_m = signed_distance_m(one.contact_planes[face], point_m);
    EXPECT_EQ(signed_distance_m(two.contact_planes[face], point_m), here_m);
    EXPECT_NEAR(signed_distance_m(two.contact_planes[kPlacedFaces + face], lifted_and_turned() * point_m),
                here_m, 1e-15);
    EXPECT_EQ(two.place_of(face), 0u);
    EXPECT_EQ(two.place_of(kPlacedFaces + face), 1u);
  }
}

TEST(ArtefactPlaces, WhatIsWrongWithAFaceIsWrongAtEachPlace) {
  const Artefact one = make_artefact(drawn::uncertain_artefact(kPlacedFaces));
  const Artefact two = make_artefact(at_two_places(PlaceDeviation{1e-5, 3e-5}));
  const auto shared = static_cast<Eigen::Index>(one.parameters.size());
  const Eigen::VectorXd errors = 1e-5 * Eigen::VectorXd::LinSpaced(shared, 1.0, 2.0);
  Eigen::VectorXd with_pose = Eigen::VectorXd::Zero(shared + 6);
  with_pose.head(shared) = errors;
  std::vector<ContactSurface> of_one, of_two;
  correct_contact_planes(one, errors, of_one);
  correct_contact_planes(two, with_pose, of_two);
  const Eigen::Vector3d point_m(-0.02, -0.11, 0.07);
  for (std::size_t face = 0; face < kPlacedFaces; ++face) {
    const double wrong_m = signed_distance_m(of_one[face], point_m);
    EXPECT_NEAR(signed_distance_m(of_two[face], point_m), wrong_m, 1e-15);
    EXPECT_NEAR(signed_distance_m(of_two[kPlacedFaces + face], lifted_and_turned() * point_m), wrong_m,
                1e-14);
  }
}

TEST(ArtefactPlaces, AnErrorOfThePoseMovesAllFacesThereAsARigidBody) {
  const Artefact artefact = make_artefact(at_two_places(std::nullopt));
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(artefact.parameters.size()));
  const Eigen::Vector3d shift_m(0.001, -0.002, 0.0005), turn(0.01, 0.02, -0.03);
  errors.segment<3>(index_of(artefact, "place_stand_x")) = shift_m;
  errors.segment<3>(index_of(artefact, "place_stand_turn_x")) = turn;
  Eigen::Isometry3d moved = lifted_and_turned();
  moved.translation() += shift_m;
  moved.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * moved.linear();
  std::vector<ContactSurface> planes;
  correct_contact_planes(artefact, errors, planes);
  const Eigen::Vector3d point_m(0.031, -0.087, 0.044);
  for (std::size_t face = 0; face < kPlacedFaces; ++face) {
    EXPECT_EQ(signed_distance_m(planes[face], point_m),
              signed_distance_m(artefact.contact_planes[face], point_m));
    EXPECT_NEAR(signed_distance_m(planes[kPlacedFaces + face], moved * point_m),
                signed_distance_m(artefact.contact_planes[face], point_m), 1e-15);
  }
}

TEST(ArtefactPlaces, ItsSlopesAreThoseOfTheDistances) {
  const Artefact artefact = make_artefact(at_two_places(std::nullopt));
  const Eigen::Vector3d point_m = lifted_and_turned() * Eigen::Vector3d(0.031, -0.087, 0.044);
  constexpr double kStep = 1e-6;
  for (std::size_t k = 0; k < artefact.parameters.size(); ++k) {
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(artefact.parameters.size()));
    errors[static_cast<Eigen::Index>(k)] = kStep;
    std::vector<ContactSurface> planes;
    correct_contact_planes(artefact, errors, planes);
    for (std::size_t face = 0; face < planes.size(); ++face) {
      const ContactSurface& nominal = artefact.contact_planes[face];
      const double slope =
          (signed_distance_m(planes[face], point_m) - signed_distance_m(nominal, point_m)) / kStep;
      EXPECT_NEAR(artefact.parameters[k].shifts[face].at({point_m, nominal.outward, nominal.outward}), slope,
                  1e-6)
          << artefact.parameters[k].name << " plane " << face + 1;
    }
  }
}

TEST(ArtefactPlaces, WhatItStandsOnGrows) {
  ArtefactKnowledge knowledge = at_two_places(PlaceDeviation{1e-5, 3e-5});
  knowledge.places[1].growth_m_per_k = {0.0, -3.6e-6, 0.0};
  const Artefact artefact = make_artefact(knowledge);
  const auto temperature = static_cast<std::size_t>(index_of(artefact, "block_temperature"));
  knowledge.places[1].growth_m_per_k.setZero();
  const Artefact without = make_artefact(knowledge);
  const Eigen::Vector3d normal = artefact.contact_planes[kPlacedFaces + 2].outward;
  const Eigen::Vector3d point_m = lifted_and_turned().translation();
  const auto slope = [&](const Artefact& of) {
    return of.parameters[temperature].shifts[kPlacedFaces + 2].at({point_m, normal, normal});
  };
  EXPECT_NEAR(slope(artefact) - slope(without), 3.6e-6 * normal.y(), 1e-12);
}

TEST(ArtefactPlaces, APlaceThatIsExactlyKnownHasNoParameters) {
  EXPECT_EQ(make_artefact(at_two_places(PlaceDeviation{})).parameters.size(),
            make_artefact(drawn::uncertain_artefact(kPlacedFaces)).parameters.size());
  EXPECT_EQ(parameters_without_prior(make_artefact(at_two_places(std::nullopt))).size(), 6u);
}

/// Lifted straight up, so that the sides of the block at both places lie in one plane.
ArtefactKnowledge lifted(std::optional<PlaceDeviation> std) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(kPlacedFaces);
  knowledge.places = {{.name = "first"}, {.name = "stand", .std = std}};
  knowledge.places[1].pose.translation() = Eigen::Vector3d(0.0, -0.3, 0.0);
  return knowledge;
}

TEST(ArtefactPlaces, FacesOfTwoPlacesMayLieInOnePlane) {
  const IdentificationProblem problem = drawn::problem(lifted(PlaceDeviation{1e-5, 3e-5}));
  EXPECT_FALSE(find_invalid_input(problem, {}));
  IdentificationProblem twice = problem;
  twice.artefact.face_count = 0;  // as if all of them stood there at once
  const auto refusal = find_invalid_input(twice, {});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, IdentificationStatus::kCoincidingPlanes);
}

/// Sampled over the faces where they stand.
std::vector<Touch> touches_at_two_places(const IdentificationProblem& problem, const drawn::Truth& truth,
                                         UniformChance& chance) {
  const std::vector<Face> flat = drawn::certain_artefact(kPlacedFaces).faces;
  std::vector<Face> faces = flat;
  for (const Face& face : flat) {
    faces.push_back(face);
    faces.back().center_m.y() -= 0.3;
    faces.back().plane.offset_m = face.plane.outward.dot(faces.back().center_m);
  }
  drawn::Manner manner{.count = 160, .block = faces};
  for (int face = 0; face < static_cast<int>(problem.artefact.contact_planes.size()); ++face)
    manner.faces.push_back(face);
  return drawn::touches(truth, manner, chance);
}

/// A hidden pose of the second place is found with the arm, and an arm that is right stays right.
TEST(ArtefactPlaces, TheTouchesFindThePlaceWithTheArm) {
  IdentificationProblem problem = drawn::problem(lifted(std::nullopt));
  UniformChance chance(7);
  Eigen::VectorXd artefact_errors = drawn::draw_artefact_errors(problem.artefact, chance);
  const int shift = index_of(problem.artefact, "place_stand_x");
  artefact_errors.segment<3>(shift) = Eigen::Vector3d(0.001, -0.0007, 0.0012);
  artefact_errors.segment<3>(shift + 3) = Eigen::Vector3d(0.003, -0.002, 0.001);
  const Attainable attainable = attainable_parameters(problem, {});
  EXPECT_EQ(attainable.count, 25);
  const IdentifiableSet identifiable = attainable_set(problem.nominal, problem.artefact, {});
  const drawn::Truth truth =
      drawn::truth_of(problem, drawn::errors_on(identifiable.columns, chance), artefact_errors);
  problem.touches = touches_at_two_places(problem, truth, chance);
  const IdentificationResult result = identify(problem, {});
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 25u);
  const Eigen::VectorXd off = result.artefact_errors.segment<6>(shift) - artefact_errors.segment<6>(shift);
  EXPECT_LT(off.head<3>().norm(), 1e-4);
  EXPECT_LT(off.tail<3>().norm(), 3e-4);
  EXPECT_NEAR(result.iterations.back().residual_rms_m, study::kTouchNoiseMetres, 5e-6);
}

}  // namespace
}  // namespace calib
