#include "config/certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/numerics/uniform_chance.hpp"

namespace cell {
namespace {

constexpr double kStdMetres = 2e-6;

/// Faces one above the other, whose offsets a drawing gives only.
Block stair(const std::vector<double>& offsets_m, bool estimated = true) {
  Block block;
  for (const double offset_m : offsets_m) {
    calib::Face face;
    face.plane = {Eigen::Vector3d::UnitZ(), offset_m};
    block.faces.push_back(face);
    block.face_uncertainties.push_back({.std_offset_m = estimated ? 0.0 : 5e-6, .estimated = estimated});
  }
  return block;
}

void add_length(Block& block, int a, int b, double value_m) {
  block.lengths.push_back({.faces = {a, b}, .value_m = value_m, .std_m = kStdMetres});
}

/// Three steps with a length between each two.
Block closed_loop(double last_m) {
  Block block = stair({0.0, 0.0502, 0.1499});
  add_length(block, 0, 1, 0.05);
  add_length(block, 1, 2, 0.1);
  add_length(block, 2, 0, last_m);
  return block;
}

TEST(Certificate, ALengthThatClosesItsLoopIsAccepted) {
  EXPECT_FALSE(find_contradicted_length(closed_loop(0.15)));
  EXPECT_FALSE(find_contradicted_length(closed_loop(0.15 + 3.0 * kStdMetres)));
}

TEST(Certificate, LengthsAroundALoopThatDoNotCloseAreFound) {
  const auto found = find_contradicted_length(closed_loop(0.15005));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->off_m, 50e-6, 1e-9);
  EXPECT_EQ(found->degrees, 1);
  // One in three variances, each with a micrometre of rounding.
  EXPECT_NEAR(found->chi_square, 2500.0 / (3.0 * 5.0), 1.0);
}

TEST(Certificate, TheLengthThatIsWrongIsNamedWhereTheOthersShowIt) {
  Block block = stair({0.0, 0.05, 0.15, 0.2});
  add_length(block, 0, 1, 0.05);
  add_length(block, 1, 2, 0.1);
  add_length(block, 2, 0, 0.15);
  add_length(block, 2, 3, 0.0501);
  add_length(block, 0, 3, 0.2);
  add_length(block, 1, 3, 0.15);
  const auto found = find_contradicted_length(block);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->length, 3U);
  EXPECT_NEAR(found->off_m, 100e-6, 1e-8);
  EXPECT_EQ(found->degrees, 3);
}

TEST(Certificate, OffsetsAndLengthsAreJudgedTogether) {
  Block block = stair({0.0, 0.05, 0.1, 0.15}, false);
  // Each alone is within what its two offsets of 5 um leave open.
  add_length(block, 0, 1, 0.05 + 18e-6);
  EXPECT_FALSE(find_contradicted_length(block));
  add_length(block, 1, 2, 0.05 + 18e-6);
  add_length(block, 2, 3, 0.05 + 18e-6);
  const auto found = find_contradicted_length(block);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->degrees, 3);
}

TEST(Certificate, OppositeFacesHaveTheSumOfTheirOffsetsBetweenThem) {
  Block block = stair({0.075, 0.075}, false);
  block.faces[1].plane.outward = -Eigen::Vector3d::UnitZ();
  add_length(block, 0, 1, 0.15);
  EXPECT_FALSE(find_contradicted_length(block));
  block.lengths.front().value_m = 0.1501;
  EXPECT_TRUE(find_contradicted_length(block));
}

TEST(Certificate, NothingIsRefusedWhereNothingIsSaidTwice) {
  EXPECT_FALSE(find_contradicted_length(stair({0.0, 0.1})));
  Block chain = stair({0.0, 0.1, 0.3});
  add_length(chain, 0, 1, 0.12);
  add_length(chain, 1, 2, 0.25);
  EXPECT_FALSE(find_contradicted_length(chain));
}

TEST(Certificate, ExactOffsetsLeaveNothingOpen) {
  Block block = stair({0.0, 0.1}, false);
  for (calib::FaceUncertainty& face : block.face_uncertainties) face.std_offset_m = 0.0;
  add_length(block, 0, 1, 0.1 + 2e-6);
  EXPECT_FALSE(find_contradicted_length(block));
  block.lengths.front().value_m = 0.1 + 20e-6;
  const auto found = find_contradicted_length(block);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->off_m, 20e-6, 1e-9);
}

// What is drawn from its own deviations is refused as seldom as the limit says; a micrometre of rounding is
// allowed besides.
TEST(Certificate, TrueOnesAreRefusedAsSeldomAsTheLimitSays) {
  calib::UniformChance chance(5);
  const auto normal = [&chance] {
    double sum = 0.0;
    for (int i = 0; i < 12; ++i) sum += chance();
    return sum - 6.0;
  };
  int refused = 0;
  constexpr int kBlocks = 3000;
  for (int i = 0; i < kBlocks; ++i) {
    Block block = closed_loop(0.15);
    for (calib::KnownLength& length : block.lengths) length.value_m += kStdMetres * normal();
    refused += find_contradicted_length(block) ? 1 : 0;
  }
  EXPECT_LE(refused, 2.0 * kCertificateChanceMin * kBlocks);
}

}  // namespace
}  // namespace cell
