#include "calib_core/identification/held_places.hpp"

#include <gtest/gtest.h>

#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

TEST(HeldPlaces, TouchesOfTheFirstPlaceHaveAResultBeforeTheNextOneIsTouched) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.places = {{.name = "first"}, {.name = "stand", .std = std::nullopt}};
  knowledge.places[1].pose.translation() = Eigen::Vector3d(0.0, -0.3, 0.0);
  IdentificationProblem problem = drawn::problem(knowledge);
  UniformChance chance(3);
  const IdentifiableSet identifiable = attainable_set(problem.nominal, problem.artefact, {});
  const drawn::Truth truth =
      drawn::truth_of(problem, drawn::errors_on(identifiable.columns, chance),
                      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.artefact.parameters.size())));
  problem.touches = drawn::touches(truth, {.count = 80, .faces = {0, 1, 2, 3}}, chance);
  EXPECT_EQ(parameters_without_prior(with_held_places(problem).artefact).size(), 0u);
  const IdentificationResult result = identify(problem, {});
  EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), 25u);
  problem.touches.push_back({.face = 7, .joints = problem.touches.back().joints});
  EXPECT_EQ(parameters_without_prior(with_held_places(problem).artefact).size(), 6u);
}

}  // namespace
}  // namespace calib
