#include "calib_core/uncertainty/tip_uncertainty.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "calib_core/numerics/halton.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

const Box kInFrontOfTheArm{"in front of the arm", {-0.3, -0.5, -0.25}, {0.3, 0.0, 0.55}};

/// Moments of gravity for the compliances to act on; masses of the size of a TX90's.
KinematicModel arm() {
  KinematicModel model = paper::nominal();
  model.masses[2] = {30.0, {0.2, 0.0, 0.1}};
  model.masses[4] = {20.0, {0.0, 0.0, -0.2}};
  model.masses[6] = {3.0, {0.0, 0.0, 0.08}};
  return model;
}

ToolCentre gripper() {
  ToolCentre tool = Eigen::Isometry3d::Identity();
  tool->translation() = Eigen::Vector3d(0.06, -0.03, 0.25);
  return tool;
}

int index_of(std::string_view name) { return error_parameter_index(name).value(); }

/// Only this error is uncertain.
ArmMatrix covariance_of(std::string_view name, double std) {
  ArmMatrix covariance = ArmMatrix::Zero();
  covariance(index_of(name), index_of(name)) = std * std;
  return covariance;
}

ArmVector random_normal(std::mt19937_64& chance) {
  std::normal_distribution<double> normal;
  ArmVector values;
  for (double& value : values) value = normal(chance);
  return values;
}

/// Correlated errors of about 0.1 mm, 0.1 mrad and 0.5 urad/Nm: C = root root^T.
ArmMatrix random_root(std::uint64_t seed) {
  std::mt19937_64 chance(seed);
  ArmMatrix root;
  for (int i = 0; i < kArmParameterCount; ++i) {
    const double scale = i < kErrorParameterCount ? 1e-4 : 5e-7;
    root.row(i) =
        scale / std::sqrt(static_cast<double>(kArmParameterCount)) * random_normal(chance).transpose();
  }
  return root;
}

ArmMatrix random_covariance(std::uint64_t seed) {
  const ArmMatrix root = random_root(seed);
  return root * root.transpose();
}

std::vector<JointVector> some_postures(int count) {
  std::vector<JointVector> postures;
  for (int i = 1; i <= count; ++i) postures.push_back(halton_posture(i, tx90::joint_ranges()));
  return postures;
}

Eigen::Vector3d point_m(const KinematicModel& model, const JointVector& joints, const ToolCentre& tool) {
  return tool_centre_in_block_m(forward_chain(model, joints), tool);
}

/// Root mean square over drawn errors and the postures of how far the arm with these errors is off.
double drawn_rms_m(const KinematicModel& model, const std::vector<JointVector>& postures,
                   const ToolCentre& tool, const ArmMatrix& root) {
  constexpr int kDraws = 4000;
  std::mt19937_64 chance(11);
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const ArmVector errors = root * random_normal(chance);
    const KinematicModel moved = apply(model, errors);
    for (const JointVector& joints : postures) {
      sum += (point_m(moved, joints, tool) - point_m(model, joints, tool)).squaredNorm();
    }
  }
  return std::sqrt(sum / (kDraws * static_cast<double>(postures.size())));
}

/// What 4000 draws can tell.
constexpr double kDrawnShare = 0.05;

TEST(TipUncertainty, IsWhatArmsWithErrorsDrawnFromTheCovarianceShow) {
  const ArmMatrix root = random_root(5);
  for (const ToolCentre& tool : {ToolCentre{}, gripper()}) {
    for (const JointVector& joints : some_postures(4)) {
      const double predicted = tip_std_m(arm(), joints, root * root.transpose(), tool);
      EXPECT_NEAR(drawn_rms_m(arm(), {joints}, tool, root) / predicted, 1.0, kDrawnShare);
    }
  }
}

TEST(TipUncertainty, OfARegionIsWhatArmsWithDrawnErrorsShowOverIt) {
  const ArmMatrix root = random_root(6);
  const std::vector<JointVector> postures = some_postures(20);
  const double predicted =
      region_over_postures(arm(), postures, gripper()).rms_m(root * root.transpose()).value();
  EXPECT_NEAR(drawn_rms_m(arm(), postures, gripper(), root) / predicted, 1.0, kDrawnShare);
}

TEST(TipUncertainty, OfACompliantJointIsHowFarGravityBendsIt) {
  ArmMatrix covariance = ArmMatrix::Zero();
  constexpr double kStdRadPerNm = 1e-6;
  const int compliance2 = nongeometric_index(compliance_position(1));
  covariance(compliance2, compliance2) = kStdRadPerNm * kStdRadPerNm;
  const JointVector joints = some_postures(1).front();
  KinematicModel softer = arm();
  softer.compliance_rad_per_nm[1] = kStdRadPerNm;  // joint 2
  const double moved_m = (point_m(softer, joints, {}) - point_m(arm(), joints, {})).norm();
  ASSERT_GT(moved_m, 1e-6);
  EXPECT_NEAR(tip_std_m(arm(), joints, covariance) / moved_m, 1.0, 1e-3);
  EXPECT_EQ(tip_std_m(paper::nominal(), joints, covariance), 0.0) << "without masses nothing bends";
}

TEST(TipUncertainty, OfAnUncertainLengthIsThatLengthEverywhere) {
  constexpr double kStdM = 1e-4;
  for (const char* name : {"r7", "d7", "r0", "d1", "r4", "d3"}) {
    const ArmMatrix covariance = covariance_of(name, kStdM);
    for (const JointVector& joints : some_postures(20)) {
      EXPECT_NEAR(tip_std_m(arm(), joints, covariance), kStdM, 1e-15) << name;
    }
    EXPECT_NEAR(region_over_joint_ranges(arm(), tx90::joint_ranges()).rms_m(covariance).value(), kStdM, 1e-15)
        << name;
  }
}

TEST(TipUncertainty, OfAnUncertainAngleGrowsWithTheDistanceFromItsAxis) {
  constexpr double kStdRad = 1e-3;
  const JointVector joints = some_postures(1).front();
  const Chain chain = forward_chain(arm(), joints);
  const Eigen::Isometry3d& frame3 = chain.block_from_frame[3];
  const double lever_m = frame3.linear().col(2).cross(chain.tip_in_block_m() - frame3.translation()).norm();
  EXPECT_NEAR(tip_std_m(arm(), joints, covariance_of("theta3", kStdRad)), kStdRad * lever_m, 1e-15);
}

TEST(TipUncertainty, OfAToolKnowsNothingOfTheProbesOwnFrame) {
  for (const char* name : {"alpha7", "d7", "theta7", "r7", "beta7"}) {
    for (const JointVector& joints : some_postures(5)) {
      EXPECT_EQ(tip_std_m(arm(), joints, covariance_of(name, 1e-3), gripper()), 0.0) << name;
    }
  }
}

TEST(TipUncertainty, OfAToolOffAxis6SeesTheta6AndTheProbeTipDoesNot) {
  const ArmMatrix covariance = covariance_of("theta6", 1e-3);
  const double off_axis_m = gripper()->translation().head<2>().norm();
  for (const JointVector& joints : some_postures(5)) {
    EXPECT_NEAR(tip_std_m(arm(), joints, covariance), 0.0, 1e-15);
    EXPECT_NEAR(tip_std_m(arm(), joints, covariance, gripper()), 1e-3 * off_axis_m, 1e-15);
  }
}

TEST(TipUncertainty, OfAToolInThePlaceOfTheBallIsTheBallsButForTheProbesErrors) {
  const ToolCentre tool = frame_transform(arm().links[7]);
  ArmMatrix covariance = random_covariance(7);
  covariance.bottomRows(kNongeometricCount + 5).topRows(5).setZero();  // frame 7's parameters come last
  covariance.rightCols(kNongeometricCount + 5).leftCols(5).setZero();
  for (const JointVector& joints : some_postures(5)) {
    EXPECT_NEAR(tip_std_m(arm(), joints, covariance, tool), tip_std_m(arm(), joints, covariance), 1e-15);
  }
}

TEST(TipRegion, MeanSquareIsThatOfItsPostures) {
  const ArmMatrix covariance = random_covariance(8);
  const std::vector<JointVector> postures = some_postures(50);
  double sum = 0.0;
  for (const JointVector& joints : postures) sum += std::pow(tip_std_m(arm(), joints, covariance), 2);
  const double wanted = std::sqrt(sum / 50.0);
  EXPECT_NEAR(region_over_postures(arm(), postures).rms_m(covariance).value(), wanted, 1e-12 * wanted);
  const TipRegion ranges = region_over_joint_ranges(arm(), tx90::joint_ranges(), {}, 50);
  EXPECT_EQ(ranges.posture_count, 50);
  EXPECT_NEAR(ranges.rms_m(covariance).value(), wanted, 1e-12 * wanted);
}

TEST(TipPostures, GiveTheErrorOfEachPosture) {
  const ArmMatrix covariance = random_covariance(11);
  const std::vector<JointVector> postures = some_postures(40);
  for (const ToolCentre& tool : {ToolCentre{}, gripper()}) {
    const TipPostures derived = derive_at_postures(arm(), postures, tool);
    const Eigen::VectorXd std_m = derived.std_m(covariance);
    ASSERT_EQ(std_m.size(), 40);
    for (std::size_t i = 0; i < postures.size(); ++i) {
      const double wanted = tip_std_m(arm(), postures[i], covariance, tool);
      EXPECT_NEAR(std_m[static_cast<Eigen::Index>(i)], wanted, 1e-12 * wanted);
    }
    EXPECT_EQ(derived.region().mean_square, region_over_postures(arm(), postures, tool).mean_square);
  }
}

TEST(TipPostures, SpreadFromTheRmsToTheWorst) {
  const ArmMatrix covariance = random_covariance(12);
  const TipPostures postures = derive_at_postures(arm(), some_postures(40));
  const TipSpread spread = postures.spread(covariance).value();
  Eigen::VectorXd std_m = postures.std_m(covariance);
  std::ranges::sort(std_m);
  EXPECT_EQ(spread.max_m, std_m[39]);
  EXPECT_EQ(spread.p95_m, std_m[37]) << "38 of 40 are 95 %";
  EXPECT_NEAR(spread.rms_m, postures.region().rms_m(covariance).value(), 1e-12 * spread.rms_m);
  EXPECT_FALSE(derive_at_postures(arm(), {}).spread(covariance));
}

TEST(TipPostures, AreAllTheSameForAnErrorThatIsTheSameEverywhere) {
  constexpr double kStdM = 1e-4;
  const TipSpread spread =
      derive_at_postures(arm(), some_postures(30)).spread(covariance_of("d3", kStdM)).value();
  for (const double figure : {spread.rms_m, spread.p95_m, spread.max_m}) EXPECT_NEAR(figure, kStdM, 1e-15);
}

TEST(TipPostures, WhatIsNotANumberIsNotZero) {
  ArmMatrix covariance = random_covariance(1);
  covariance(3, 4) = std::numeric_limits<double>::quiet_NaN();
  const TipSpread spread = derive_at_postures(arm(), some_postures(3)).spread(covariance).value();
  for (const double figure : {spread.rms_m, spread.p95_m, spread.max_m}) EXPECT_TRUE(std::isnan(figure));
}

TEST(TipRegion, TheUsualCountOfPosturesIsEnoughForTheJointRanges) {
  const TipRegion usual = region_over_joint_ranges(arm(), tx90::joint_ranges(), gripper());
  const TipRegion many = region_over_joint_ranges(arm(), tx90::joint_ranges(), gripper(), 20000);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ArmMatrix covariance = random_covariance(seed);
    EXPECT_NEAR(usual.rms_m(covariance).value() / many.rms_m(covariance).value(), 1.0, 0.03) << seed;
  }
}

TEST(TipRegion, PosturesInABoxHaveThePointInside) {
  for (const ToolCentre& tool : {ToolCentre{}, gripper()}) {
    const auto postures = postures_in_box(arm(), tx90::joint_ranges(), kInFrontOfTheArm, tool, 300);
    EXPECT_EQ(postures.size(), 300U);
    for (const JointVector& joints : postures) {
      EXPECT_TRUE(tx90::joint_ranges().contains(joints));
      const Eigen::AlignedBox3d box(kInFrontOfTheArm.min_m, kInFrontOfTheArm.max_m);
      EXPECT_TRUE(box.contains(point_m(arm(), joints, tool)));
    }
    EXPECT_EQ(region_over_box(arm(), tx90::joint_ranges(), kInFrontOfTheArm, tool, 300).posture_count, 300);
  }
}

TEST(TipRegion, WithoutAPostureHasNoFigure) {
  const Box far{"out of reach", {5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}};
  const TipRegion region = region_over_box(arm(), tx90::joint_ranges(), far, {}, 20);
  EXPECT_EQ(region.posture_count, 0);
  EXPECT_FALSE(region.rms_m(random_covariance(1)));
  EXPECT_FALSE(region_over_postures(arm(), {}).rms_m(random_covariance(1)));
}

TEST(TipRegion, WhatIsNotANumberIsNotZero) {
  ArmMatrix covariance = random_covariance(1);
  covariance(3, 4) = std::numeric_limits<double>::quiet_NaN();
  const JointVector joints = some_postures(1).front();
  EXPECT_TRUE(std::isnan(tip_std_m(arm(), joints, covariance)));
  EXPECT_TRUE(std::isnan(region_over_postures(arm(), {&joints, 1}).rms_m(covariance).value()));
}

TEST(TipRegion, TakesAPrismaticJointsRangeInMetres) {
  KinematicModel model = arm();
  model.joint_types[2] = JointType::kPrismatic;
  JointRanges ranges = tx90::joint_ranges();
  ranges.lower[2] = 0.0;
  ranges.upper[2] = 0.4;
  const ArmMatrix root = random_root(9);
  std::vector<JointVector> postures;
  for (int i = 1; i <= 10; ++i) postures.push_back(halton_posture(i, ranges));
  const double predicted =
      region_over_joint_ranges(model, ranges, {}, 10).rms_m(root * root.transpose()).value();
  EXPECT_NEAR(drawn_rms_m(model, postures, {}, root) / predicted, 1.0, kDrawnShare);
}

TEST(BoxGrid, CellsHaveAboutTheWantedEdgeAndFillTheBoxXFastest) {
  const BoxGrid grid = divide_box({"box", {-0.3, -0.5, -0.25}, {0.32, 0.0, 0.55}}, 0.1);
  EXPECT_EQ(grid.counts, (std::array{6, 5, 8}));
  EXPECT_NEAR(grid.cell_size_m[0], 0.62 / 6, 1e-15);
  int wanted = 0;
  for (int z = 0; z < 8; ++z) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 6; ++x) {
        const Eigen::Vector3d centre =
            grid.min_m + grid.cell_size_m.cwiseProduct(Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5));
        EXPECT_EQ(grid.cell_of(centre), wanted++);
      }
    }
  }
  EXPECT_EQ(grid.cell_count(), wanted);
}

TEST(BoxGrid, TheBoxHasItsOwnFacesAndNothingBeyondThem) {
  const BoxGrid grid = divide_box({"box", {0, 0, 0}, {1, 1, 1}}, 0.5);
  EXPECT_EQ(grid.cell_of({0, 0, 0}), 0);
  EXPECT_EQ(grid.cell_of({1, 1, 1}), 7);
  EXPECT_FALSE(grid.cell_of({1.0001, 0.5, 0.5}));
  EXPECT_FALSE(grid.cell_of({0.5, -0.0001, 0.5}));
  EXPECT_FALSE(grid.cell_of({0.5, std::numeric_limits<double>::quiet_NaN(), 0.5}));
  EXPECT_EQ(divide_box({"box", {0, 0, 0}, {1, 1, 0.01}}, 0.5).counts[2], 1) << "a thin box has one layer";
}

TEST(BoxGrid, NeedsExtent) {
  EXPECT_THROW(divide_box(kInFrontOfTheArm, 0.0), std::logic_error);
  EXPECT_THROW(divide_box({"flat", {0, 0, 0}, {1, 0, 1}}, 0.1), std::logic_error);
}

TEST(UncertaintyMap, MeanSquareOverItsCellsIsTheRegions) {
  const ArmMatrix covariance = random_covariance(10);
  const auto postures = postures_in_box(arm(), tx90::joint_ranges(), kInFrontOfTheArm, gripper(), 1000);
  const TipMap cells = make_tip_map(arm(), postures, divide_box(kInFrontOfTheArm, 0.1), gripper());
  const UncertaintyMap map = cells.evaluate(covariance);
  ASSERT_EQ(std::ssize(map.rms_m), map.grid.cell_count());
  double sum = 0.0;
  int count = 0, empty = 0;
  for (std::size_t i = 0; i < map.rms_m.size(); ++i) {
    EXPECT_EQ(map.rms_m[i].has_value(), cells.cells[i].posture_count > 0);
    if (!map.rms_m[i]) ++empty;
    sum += cells.cells[i].posture_count * std::pow(map.rms_m[i].value_or(0.0), 2);
    count += cells.cells[i].posture_count;
  }
  EXPECT_EQ(count, 1000);
  EXPECT_LT(empty, map.grid.cell_count() / 2);
  const double wanted = region_over_postures(arm(), postures, gripper()).rms_m(covariance).value();
  EXPECT_NEAR(std::sqrt(sum / count), wanted, 1e-12 * wanted);
}

TEST(UncertaintyMap, ACellHoldsThePosturesThatFallIntoItAndIsEmptyWithoutAny) {
  const JointVector joints = postures_in_box(arm(), tx90::joint_ranges(), kInFrontOfTheArm, {}, 1).front();
  const JointVector outside = tx90::degrees(180, 0, 60, 0, 90, 0);  // behind the arm
  const BoxGrid grid = divide_box(kInFrontOfTheArm, 0.1);
  ASSERT_FALSE(grid.cell_of(point_m(arm(), outside, {})));
  const int cell = grid.cell_of(point_m(arm(), joints, {})).value();
  const ArmMatrix covariance = random_covariance(12);
  const auto rms_m = make_tip_map(arm(), std::vector{joints, outside}, grid).evaluate(covariance).rms_m;
  for (int i = 0; i < grid.cell_count(); ++i) {
    EXPECT_EQ(rms_m[static_cast<std::size_t>(i)].has_value(), i == cell);
  }
  const double wanted = tip_std_m(arm(), joints, covariance);
  EXPECT_NEAR(rms_m[static_cast<std::size_t>(cell)].value(), wanted, 1e-12 * wanted);
}

}  // namespace
}  // namespace calib
