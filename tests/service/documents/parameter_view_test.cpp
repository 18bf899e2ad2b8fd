#include "service/documents/parameter_view.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calib_core/geometry/units.hpp"
#include "tests/service/document_shape.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

TEST(ResultDocument, AnIntervalIsTheErrorAndTheCoverageFactorTimesItsDeviation) {
  const calib::IdentificationProblem problem = problem_of(edf().recipes.at("edf-25"));
  const auto identified = calib::identify(problem, edf().recipes.at("edf-25").identification);
  const calib::UncertaintyBudget& uncertainty = identified.uncertainty.value();
  int seen = 0;
  for (const json& found : result().at("parameters")) {
    if (found.at("status") != "identified") continue;
    const double error = found.at("error").get<double>();
    const int index = calib::error_parameter_index(found.at("name").get<std::string>()).value();
    const double factor = uncertainty.coverage_factor_of(std::pow(uncertainty.std_error(index), 2),
                                                         uncertainty.of_noise(index, index));
    const double half = factor * found.at("std_uncertainty").get<double>();
    EXPECT_NEAR(found.at("interval95")[0].get<double>(), error - half, 1e-12 + 1e-9 * std::abs(error));
    EXPECT_NEAR(found.at("interval95")[1].get<double>(), error + half, 1e-12 + 1e-9 * std::abs(error));
    ++seen;
  }
  EXPECT_EQ(seen, result().at("identifiable_count"));
}

TEST(ResultDocument, WhatAnErrorStandsForIsTheOtherSideOfTheGroups) {
  std::map<std::pair<std::string, std::string>, double> grouped, carried;
  for (const json& found : result().at("parameters")) {
    for (const json& other : found.at("grouped_with"))
      grouped[{found.at("name"), other.at("name")}] = other.at("factor");
    for (const json& other : found.at("stands_for"))
      carried[{other.at("name"), found.at("name")}] = other.at("factor");
  }
  EXPECT_FALSE(grouped.empty());
  EXPECT_EQ(grouped, carried);
}

TEST(ResultDocument, AFaceInPlaceThatNothingTellsFromThePlaceOfTheArmRejectsTheResult) {
  // No face across x is known, no gravity: the arm's place along x and plane 2 are one.
  calib::IdentificationProblem problem = problem_of(edf().recipes.at("edf-25"));
  problem.nominal.masses = {};
  problem.nongeometric_std = {};
  calib::ArtefactKnowledge knowledge = artefact_knowledge(edf());
  knowledge.face_uncertainties.at(1).estimated = true;
  problem.artefact = calib::make_artefact(knowledge);
  problem.attainable.reset();
  const json document =
      document_of(problem, calib::identify(problem, edf().recipes.at("edf-25").identification));
  const auto named = [](const json& list, const std::string& name) {
    return *std::ranges::find_if(list, [&](const json& one) { return one.at("name") == name; });
  };
  const json d1 = named(document.at("parameters"), "d1");
  EXPECT_EQ(d1.at("status"), "grouped");
  ASSERT_EQ(d1.at("grouped_with").size(), 1U) << d1;
  EXPECT_EQ(d1.at("grouped_with")[0].at("name"), "plane2_offset");
  EXPECT_NEAR(std::abs(d1.at("grouped_with")[0].at("factor").get<double>()), 1.0, 1e-9);
  const double miss_mm = calib::mm_from_metres(edf().nominal_position_error_m);
  const double std_mm = named(document.at("artefact_parameters"), "plane2_offset").at("std_uncertainty");
  EXPECT_GE(std_mm, miss_mm);
  const json gain = named(document.at("verdict").at("decision_rule").at("criteria"), "nominal_miss");
  EXPECT_EQ(gain.at("within_limit"), false);
  EXPECT_GT(gain.at("value").get<double>(), miss_mm);
  EXPECT_EQ(document.at("verdict").at("accepted"), false);
}

TEST(ResultDocument, WithAPriorEveryErrorIsIdentifiedAndTheRankStaysThatOfTheTouches) {
  Recipe recipe = edf().recipes.at("edf-25");
  recipe.identification.prior = true;
  const json document = result_with(recipe);
  ASSERT_EQ(document.at("converged"), true) << document.at("verdict");
  EXPECT_EQ(document.at("identifiable_count"), result().at("identifiable_count"));
  for (const json& found : document.at("parameters")) {
    EXPECT_EQ(found.at("status"), "identified");
    EXPECT_TRUE(found.at("error").is_number()) << found;
    EXPECT_TRUE(found.at("std_uncertainty").is_number()) << found;
    EXPECT_TRUE(found.at("grouped_with").empty());
    EXPECT_TRUE(found.at("stands_for").empty());
  }
}

TEST(ArtefactParameters, AreNotIdentifiedByTheirCertificate) {
  Cell certified = edf();
  certified.block.lengths = {{{0, 3}, 0.150, 2e-6}};
  const Recipe& recipe = certified.recipes.at("edf-25");
  calib::IdentificationProblem problem = identification_problem(certified, recipe);
  problem.touches = table3_touches();
  const auto found = artefact_parameters_of(problem, calib::identify(problem, recipe.identification));
  int seen = 0;
  for (const ArtefactParameter& offset : found) {
    if (offset.name != "plane1_offset" && offset.name != "plane4_offset") continue;
    // Within 0.02 mm each as written, and less as they cannot both be off outwards.
    EXPECT_NEAR(offset.std_uncertainty.value(), 0.02 / std::sqrt(2.0), 0.0007) << offset.name;
    EXPECT_EQ(offset.status, ArtefactStatus::kPrior) << offset.name;
    ++seen;
  }
  EXPECT_EQ(seen, 2);
}

TEST(ResultDocument, ShowsLengthsInMillimetresAndAnglesInRadians) {
  const json errors = json_of(kSourceDir / "tests/data/table3-exact.expected.json").at("identified_errors");
  for (const auto& [name, error] : errors.items()) {
    const json& found = parameter(name);
    const bool length = found.at("unit") == "mm";
    EXPECT_EQ(length, name[0] == 'd' || name[0] == 'r') << name;
    EXPECT_EQ(found.at("status"), "identified") << name;
    EXPECT_NEAR(found.at("error").get<double>(), error.get<double>() * (length ? 1e3 : 1.0),
                length ? 1e-6 : 1e-9)
        << name;
  }
  EXPECT_NEAR(parameter("r0").at("nominal").get<double>(), 149.6, 1e-9);
  EXPECT_NEAR(parameter("theta7").at("nominal").get<double>(), -0.256, 1e-12);
}

TEST(ResultDocument, ListsAllParametersInTheContractsOrderWithTheirGroups) {
  const json& parameters = result().at("parameters");
  ASSERT_EQ(parameters.size(), static_cast<std::size_t>(calib::kErrorParameterCount));
  const std::set<std::string> place{"theta0", "r0", "alpha1", "d1", "theta1", "r1"};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string name = calib::error_parameters()[i].name();
    EXPECT_EQ(parameters[i].at("name"), name);
    EXPECT_EQ(name, parameters[i].at("kind").get<std::string>() +
                        std::to_string(parameters[i].at("frame").get<int>()));
    EXPECT_EQ(parameters[i].at("group"), place.contains(name) ? "place"
                                         : name.back() == '7' ? "tool"
                                                              : "arm")
        << name;
  }
}

TEST(ResultDocument, WithTheRecipeOfThePaper23AreIdentifiedAndTheRestIsNamed) {
  const json document = result_with(edf().recipes.at("edf-23"));
  std::map<std::string, int> count;
  for (const json& found : document.at("parameters")) ++count[found.at("status")];
  EXPECT_EQ(count, (std::map<std::string, int>{
                       {"identified", 23}, {"excluded", 2}, {"no_effect", 3}, {"grouped", 9}}));
  EXPECT_EQ(document.at("identifiable_count"), 23);
}

TEST(ResultDocument, AGroupedErrorIsTheSumOfTheOthersInTheUnitsShown) {
  const calib::KinematicModel& model = edf().arm.model;
  const auto planes = calib::make_artefact(artefact_knowledge(edf())).contact_planes;
  std::vector<calib::Touch> on_face;
  for (const calib::Touch& touch : table3_touches())
    on_face.push_back(moved_onto_plane(model, planes[static_cast<std::size_t>(touch.face)], touch));
  const auto matrix = observe(model, planes, on_face, calib::Formulation::kSignedDistance).matrix;
  const auto column_a_shown_unit = [&](const std::string& name) -> Eigen::VectorXd {
    const int index = calib::error_parameter_index(name).value();
    return matrix.col(index) * (parameter(name).at("unit") == "mm" ? 1e-3 : 1.0);
  };
  int mixed_units = 0;
  for (const json& found : result().at("parameters")) {
    EXPECT_EQ(found.at("status") == "grouped", !found.at("grouped_with").empty()) << found;
    if (found.at("status") != "grouped") continue;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(matrix.rows());
    for (const json& other : found.at("grouped_with")) {
      EXPECT_EQ(shape_of(other), (Shape{{"name", "string"}, {"factor", "number"}}));
      sum += other.at("factor").get<double>() * column_a_shown_unit(other.at("name"));
      if (parameter(other.at("name")).at("unit") != found.at("unit")) ++mixed_units;
    }
    const Eigen::VectorXd own = column_a_shown_unit(found.at("name"));
    EXPECT_LT((own - sum).norm(), 1e-9 * own.norm()) << found;
  }
  EXPECT_GT(mixed_units, 0) << "no group mixes lengths and angles: the test shows nothing";
}

}  // namespace
}  // namespace cell
