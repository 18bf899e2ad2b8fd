#include "calib_core/estimation/artefact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <tuple>

#include "tests/calib_core/drawn_cell.hpp"

/// What is known of the artefact, as parameters: each shifts the distance as the changed artefact would.
namespace calib {
namespace {

ArtefactKnowledge everything_uncertain() {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.warmer_than_20_c_k = 4.0;
  return knowledge;
}

const Eigen::Vector3d kBallCenter(0.14, -0.18, 0.11);

/// The same with a ball as the sixth face.
ArtefactKnowledge with_ball(const Eigen::Vector3d& center_m = kBallCenter, double radius_m = 0.025) {
  ArtefactKnowledge knowledge = everything_uncertain();
  knowledge.faces.push_back(sphere_face(center_m, radius_m, {0, -1, 0}, 1.5));
  knowledge.face_uncertainties.push_back({.std_offset_m = 1e-6, .std_center_m = 1e-3});
  return knowledge;
}

const ArtefactParameter& parameter(const Artefact& artefact, const std::string& name) {
  for (const ArtefactParameter& candidate : artefact.parameters) {
    if (candidate.name == name) return candidate;
  }
  throw std::logic_error("no parameter " + name);
}

void turn(Face& face, const Eigen::Vector3d& edge, double angle_rad) {
  const Eigen::AngleAxisd turned(angle_rad, edge);
  face.plane.outward = turned * face.plane.outward;
  face.edge_u = turned * face.edge_u;
  face.plane.offset_m = face.plane.outward.dot(face.center_m);
}

struct Change {
  std::string name;
  double by;
  std::function<void(ArtefactKnowledge&, double)> apply;
};

TEST(Artefact, ShiftsDistancesAsTheChangedArtefactDoes) {
  const std::vector<Change> changes{
      {"plane3_offset", 1e-6, [](auto& knowledge, double by) { knowledge.faces[2].plane.offset_m += by; }},
      {"plane4_tilt_u", 1e-6,
       [](auto& knowledge, double by) { turn(knowledge.faces[3], knowledge.faces[3].edge_u, by); }},
      {"plane2_tilt_v", 1e-6,
       [](auto& knowledge, double by) { turn(knowledge.faces[1], knowledge.faces[1].edge_v(), by); }},
      {"stylus_radius", 1e-6, [](auto& knowledge, double by) { knowledge.stylus.radius_m += by; }},
      {"pretravel", 1e-6, [](auto& knowledge, double by) { knowledge.stylus.pretravel_m += by; }},
      {"block_temperature", 1e-2, [](auto& knowledge, double by) { knowledge.warmer_than_20_c_k += by; }}};
  const Artefact before = make_artefact(everything_uncertain());
  const Eigen::Vector3d point_m(0.031, -0.087, 0.044);
  for (const Change& change : changes) {
    ArtefactKnowledge knowledge = everything_uncertain();
    change.apply(knowledge, change.by);
    const Artefact after = make_artefact(knowledge);
    for (std::size_t face = 0; face < before.contact_planes.size(); ++face) {
      const double shifted_m = signed_distance_m(after.contact_planes[face], point_m) -
                               signed_distance_m(before.contact_planes[face], point_m);
      const auto& shift = parameter(before, change.name).shifts[face];
      // To first order, and the tilted face at 20 degrees C: the block's growth times the change.
      EXPECT_NEAR(shifted_m, change.by * (shift.constant + shift.per_metre.dot(point_m)), 2e-4 * change.by)
          << change.name << " plane " << face + 1;
    }
  }
}

TEST(Artefact, ShiftsDistancesFromASphereAsTheChangedSphereDoes) {
  constexpr double kBy = 1e-6;
  const Artefact before = make_artefact(with_ball());
  ArtefactKnowledge warmer = with_ball();
  warmer.warmer_than_20_c_k += 1e4 * kBy;
  const std::vector<std::tuple<std::string, double, ArtefactKnowledge>> changes{
      {"plane6_center_x", kBy, with_ball(kBallCenter + kBy * Eigen::Vector3d::UnitX())},
      {"plane6_center_y", kBy, with_ball(kBallCenter + kBy * Eigen::Vector3d::UnitY())},
      {"plane6_center_z", kBy, with_ball(kBallCenter + kBy * Eigen::Vector3d::UnitZ())},
      {"plane6_radius", kBy, with_ball(kBallCenter, 0.025 + kBy)},
      {"block_temperature", 1e4 * kBy, warmer}};
  const ContactSurface& ball = before.contact_planes[5];
  const Eigen::Vector3d point_m(0.155, -0.195, 0.125);
  for (const auto& [name, by, knowledge] : changes) {
    const auto shift =
        parameter(before, name).shifts[5].at({point_m, normal_at(ball, point_m), Eigen::Vector3d::Zero()});
    const double shifted_m = signed_distance_m(make_artefact(knowledge).contact_planes[5], point_m) -
                             signed_distance_m(ball, point_m);
    EXPECT_NEAR(shifted_m, by * shift, 2e-4 * kBy) << name;
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(std::ssize(before.parameters));
    errors[&parameter(before, name) - before.parameters.data()] = by;
    std::vector<ContactSurface> corrected;
    correct_contact_planes(before, errors, corrected);
    EXPECT_NEAR(signed_distance_m(corrected[5], point_m) - signed_distance_m(ball, point_m), shifted_m,
                2e-4 * kBy)
        << name;
    EXPECT_EQ(parameter(before, name).shifts[2].center, Eigen::Vector3d::Zero()) << name;
  }
}

ArtefactKnowledge with_bore(const Eigen::Vector3d& moved_m = Eigen::Vector3d::Zero(),
                            const Eigen::Vector3d& turned_rad = Eigen::Vector3d::Zero(),
                            double wider_m = 0.0) {
  ArtefactKnowledge knowledge = everything_uncertain();
  Face bore = drawn::bore();
  bore.bore->center_m += moved_m;
  const Eigen::AngleAxisd turned(turned_rad.norm(),
                                 turned_rad.isZero() ? Eigen::Vector3d::UnitX() : turned_rad.normalized());
  knowledge.faces.push_back(bore_face({.center_m = bore.bore->center_m, .axis = turned * bore.bore->axis},
                                      0.042 + wider_m, turned * Eigen::Vector3d::UnitX(), 0.020));
  knowledge.face_uncertainties.push_back(
      {.std_offset_m = 1e-6, .std_tilt_rad = 5e-3, .estimated = true, .std_center_m = 1e-3});
  return knowledge;
}

TEST(Artefact, ShiftsDistancesFromABoreAsTheChangedBoreDoes) {
  constexpr double kBy = 1e-6;
  const Artefact before = make_artefact(with_bore());
  ArtefactKnowledge warmer = with_bore();
  warmer.warmer_than_20_c_k += 1e6 * kBy;
  const Eigen::Vector3d none = Eigen::Vector3d::Zero(), u = Eigen::Vector3d::UnitX(),
                        v = Eigen::Vector3d::UnitZ();  // axis x u = (0, -1, 0) x (1, 0, 0)
  const std::vector<std::tuple<std::string, double, ArtefactKnowledge>> changes{
      {"plane6_axis_u", kBy, with_bore(kBy * u)},
      {"plane6_axis_v", kBy, with_bore(kBy * v)},
      {"plane6_tilt_u", 1e2 * kBy, with_bore(none, 1e2 * kBy * u)},
      {"plane6_tilt_v", 1e2 * kBy, with_bore(none, 1e2 * kBy * v)},
      {"plane6_radius", kBy, with_bore(none, none, kBy)},
      {"block_temperature", 1e6 * kBy, warmer}};
  const ContactSurface& bore = before.contact_planes[5];
  const Eigen::Vector3d point_m = drawn::bore().bore->center_m + Eigen::Vector3d(0.022, 0.015, -0.031);
  for (const auto& [name, by, knowledge] : changes) {
    const auto shift =
        parameter(before, name).shifts[5].at({point_m, normal_at(bore, point_m), Eigen::Vector3d::Zero()});
    const double shifted_m = signed_distance_m(make_artefact(knowledge).contact_planes[5], point_m) -
                             signed_distance_m(bore, point_m);
    EXPECT_NEAR(shifted_m, by * shift, 2e-3 * kBy) << name;
    EXPECT_GT(std::abs(shifted_m), 0.1 * kBy) << name;
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(std::ssize(before.parameters));
    errors[&parameter(before, name) - before.parameters.data()] = by;
    std::vector<ContactSurface> corrected;
    correct_contact_planes(before, errors, corrected);
    EXPECT_NEAR(signed_distance_m(corrected[5], point_m) - signed_distance_m(bore, point_m), shifted_m,
                2e-3 * kBy)
        << name;
  }
}

TEST(Artefact, FreesThePlaceOfAnEstimatedBoreAndKeepsTheDeviationsOfTiltAndRadius) {
  const Artefact artefact = make_artefact(with_bore());
  EXPECT_FALSE(parameter(artefact, "plane6_axis_u").std);
  EXPECT_FALSE(parameter(artefact, "plane6_axis_v").std);
  EXPECT_EQ(parameter(artefact, "plane6_tilt_u").std, 5e-3);
  EXPECT_EQ(parameter(artefact, "plane6_radius").std, 1e-6);
  EXPECT_DOUBLE_EQ(parameter(artefact, "plane6_radius").nominal, 0.042);
  EXPECT_EQ(parameter(artefact, "plane6_axis_u").nominal, 0.14);
  EXPECT_EQ(parameter(artefact, "plane6_axis_v").nominal, 0.11);
}

TEST(Artefact, KeepsTheDeviationOfAnEstimatedSpheresRadius) {
  ArtefactKnowledge knowledge = with_ball();
  knowledge.face_uncertainties[5].estimated = true;
  const Artefact artefact = make_artefact(knowledge);
  EXPECT_FALSE(parameter(artefact, "plane6_center_y").std);
  EXPECT_EQ(parameter(artefact, "plane6_radius").std, 1e-6);
  EXPECT_DOUBLE_EQ(parameter(artefact, "plane6_radius").nominal, 0.025);
  EXPECT_EQ(parameter(artefact, "plane6_center_y").nominal, -0.18);
}

TEST(Artefact, HasAParameterForWhatIsUncertainOnly) {
  EXPECT_TRUE(make_artefact(drawn::certain_artefact(5)).parameters.empty());
  const Artefact artefact = make_artefact(everything_uncertain());
  ASSERT_EQ(artefact.parameters.size(), 5u * 3u + 3u);
  std::set<std::string> names;
  for (const ArtefactParameter& each : artefact.parameters) {
    names.insert(each.name);
    EXPECT_EQ(each.shifts.size(), 5u);
    EXPECT_GT(each.std.value(), 0.0);
  }
  EXPECT_EQ(names.size(), artefact.parameters.size());
  EXPECT_EQ(parameter(artefact, "block_temperature").nominal, 24.0);
  EXPECT_EQ(parameter(artefact, "stylus_radius").nominal, 0.003);
  ArtefactKnowledge no_expansion = everything_uncertain();
  no_expansion.thermal_expansion_per_k = 0.0;
  EXPECT_EQ(make_artefact(no_expansion).parameters.size(), 5u * 3u + 2u);
}

TEST(Artefact, TellsAnEstimatedFaceByHavingNoStandardDeviation) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.face_uncertainties[4].estimated = true;
  const Artefact artefact = make_artefact(knowledge);
  for (const ArtefactParameter& each : artefact.parameters) {
    EXPECT_EQ(each.std.has_value(), !each.name.starts_with("plane5_")) << each.name;
  }
}

TEST(Artefact, MakesALengthAnEquationBetweenOffsets) {
  // Whatever the offsets' errors are, weight * error = value exactly when the faces lie the length apart.
  for (const auto& faces : {std::array{2, 4}, std::array{4, 2}, std::array{0, 3}}) {
    ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
    const auto apart_m = [&](double first_moved, double second_moved) {
      const Plane& first = knowledge.faces[static_cast<std::size_t>(faces[0])].plane;
      const Plane& second = knowledge.faces[static_cast<std::size_t>(faces[1])].plane;
      const Eigen::Vector3d on_first = (first.offset_m + first_moved) * first.outward;
      const Eigen::Vector3d on_second = (second.offset_m + second_moved) * second.outward;
      return std::abs((on_first - on_second).dot(first.outward));
    };
    const double first_moved = 30e-6, second_moved = -70e-6;
    knowledge.lengths = {{faces, apart_m(first_moved, second_moved), 2e-6}};
    const Artefact artefact = make_artefact(knowledge);
    ASSERT_EQ(artefact.equations.size(), 1u);
    const ArtefactEquation& equation = artefact.equations[0];
    // The offsets say it within 7 um already: only the rest is new.
    EXPECT_NEAR(std::pow(equation.std_m, -2), std::pow(2e-6, -2) - 0.5 * std::pow(5e-6, -2), 1.0);
    double sum = 0.0;
    for (const auto& [index, weight] : equation.weights) {
      const std::string& name = artefact.parameters[static_cast<std::size_t>(index)].name;
      const bool is_first = name == "plane" + std::to_string(faces[0] + 1) + "_offset";
      EXPECT_TRUE(is_first || name == "plane" + std::to_string(faces[1] + 1) + "_offset") << name;
      sum += weight * (is_first ? first_moved : second_moved);
    }
    EXPECT_NEAR(sum, equation.value_m, 1e-15);
  }
}

TEST(Artefact, ALengthBetweenExactlyKnownFacesSaysNothing) {
  ArtefactKnowledge knowledge = drawn::certain_artefact(5);
  knowledge.lengths = {{{2, 4}, 0.150, 2e-6}};
  EXPECT_TRUE(make_artefact(knowledge).equations.empty());
}

/// Standard deviation of the distance of two parallel faces before any touch; `sign` -1 on the same side.
double std_of_distance_m(const Artefact& artefact, int a, int b, double sign) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(std::ssize(artefact.parameters));
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    const std::string& name = artefact.parameters[static_cast<std::size_t>(k)].name;
    if (name == "plane" + std::to_string(a + 1) + "_offset") direction[k] = 1.0;
    if (name == "plane" + std::to_string(b + 1) + "_offset") direction[k] = sign;
  }
  return std::sqrt(direction.dot(prior_covariance(artefact) * direction));
}

TEST(Certificate, OfOffsetsAndLengthsCountsOnce) {
  // Offsets within 5 um: without a length the distance is known within 7.07 um, with it as it says.
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  const double of_offsets_m = std::sqrt(2.0) * 5e-6;
  EXPECT_NEAR(std_of_distance_m(make_artefact(knowledge), 2, 4, -1.0), of_offsets_m, 1e-12);
  for (const double std_m : {1e-6, 5e-6, 7e-6}) {
    knowledge.lengths = {{{2, 4}, 0.150, std_m}, {{3, 0}, 0.150, 0.5 * std_m}};
    const Artefact artefact = make_artefact(knowledge);
    EXPECT_EQ(artefact.equations.size(), 2u);
    EXPECT_NEAR(std_of_distance_m(artefact, 2, 4, -1.0), std_m, 1e-12);
    EXPECT_NEAR(std_of_distance_m(artefact, 0, 3, 1.0), 0.5 * std_m, 1e-12);
    const Eigen::MatrixXd covariance = prior_covariance(artefact);
    for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
      EXPECT_LE(covariance(k, k),
                std::pow(*artefact.parameters[static_cast<std::size_t>(k)].std, 2) * 1.000001);
    }
  }
}

TEST(Certificate, ALengthThatTheOffsetsAlreadyTellBetterSaysNothing) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.lengths = {{{2, 4}, 0.1500001, 8e-6}};
  const Artefact artefact = make_artefact(knowledge);
  EXPECT_TRUE(artefact.equations.empty());
  EXPECT_NEAR(std_of_distance_m(artefact, 2, 4, -1.0), std::sqrt(2.0) * 5e-6, 1e-12);
}

TEST(Certificate, HoldsThreeLengthsBetweenThreeFacesTogether) {
  // Three statements of 4 um that close: each distance is known a little better than by its own.
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.lengths = {{{0, 3}, 0.150, 4e-6}};
  knowledge.faces.push_back(knowledge.faces[0]);
  knowledge.faces.back().plane.offset_m = 0.050;
  knowledge.face_uncertainties.push_back(knowledge.face_uncertainties[0]);
  knowledge.lengths.push_back({{0, 5}, 0.025, 4e-6});
  knowledge.lengths.push_back({{5, 3}, 0.125, 4e-6});
  const Artefact artefact = make_artefact(knowledge);
  EXPECT_EQ(artefact.equations.size(), 2u);  // the sum of all three offsets is no length
  EXPECT_NEAR(std_of_distance_m(artefact, 0, 3, 1.0), 4e-6 * std::sqrt(2.0 / 3.0), 1e-11);
  EXPECT_NEAR(std_of_distance_m(artefact, 0, 5, -1.0), 4e-6 * std::sqrt(2.0 / 3.0), 1e-11);
}

TEST(Certificate, TiesFacesThatAreFoundInPlace) {
  ArtefactKnowledge knowledge = drawn::uncertain_artefact(5);
  knowledge.face_uncertainties[2].estimated = knowledge.face_uncertainties[4].estimated = true;
  EXPECT_GT(std_of_distance_m(make_artefact(knowledge), 2, 4, -1.0), 0.01);
  knowledge.lengths = {{{2, 4}, 0.150, 5e-6}};
  EXPECT_NEAR(std_of_distance_m(make_artefact(knowledge), 2, 4, -1.0), 5e-6, 0.2e-6);
}

}  // namespace
}  // namespace calib
