#include "calib_core/planning/internal/face_interleaving.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace calib {
namespace {

/// Touches of faces 0, 1, ...
std::vector<int> faces_with(const std::vector<int>& counts) {
  std::vector<int> faces;
  for (std::size_t face = 0; face < counts.size(); ++face) {
    faces.insert(faces.end(), static_cast<std::size_t>(counts[face]), static_cast<int>(face));
  }
  return faces;
}

/// Any face that may come next, by chance.
std::vector<int> interleaved(const std::vector<int>& faces, std::mt19937& chance, int before = -1) {
  FaceInterleaving interleaving(faces, before);
  std::vector<int> order;
  while (order.size() < faces.size()) {
    const std::vector<int> next = interleaving.next_faces();
    order.push_back(next.at(chance() % next.size()));
    interleaving.take(order.back());
  }
  return order;
}

TEST(FaceInterleaving, NeverHasAFaceFollowItselfNorRunAheadOfItsShare) {
  std::mt19937 chance(1);
  for (const auto& counts : std::vector<std::vector<int>>{
           {10, 10, 10, 10}, {20, 20, 20, 20, 20}, {16, 6, 6, 6, 6}, {3, 5, 12, 9, 11}, {20, 19}, {1, 1}}) {
    for (int draw = 0; draw < 50; ++draw) {
      std::vector<int> order = interleaved(faces_with(counts), chance);
      EXPECT_EQ(interleaving_violations(order), 0) << ::testing::PrintToString(order);
      std::ranges::sort(order);
      EXPECT_EQ(order, faces_with(counts));
    }
  }
}

TEST(FaceInterleaving, BeginsWithAnotherFaceThanTheOneBefore) {
  std::mt19937 chance(1);
  for (int draw = 0; draw < 50; ++draw) EXPECT_NE(interleaved(faces_with({10, 10}), chance, 1).front(), 1);
}

TEST(FaceInterleaving, UsesTheOtherFacesUpBetweenThoseOfOneThatHasMoreThanAll) {
  std::mt19937 chance(1);
  const std::vector<int> order = interleaved(faces_with({8, 2, 2}), chance);
  const auto is_pair = [&](std::size_t i) { return order[i] == order[i - 1]; };
  int pairs = 0;
  for (std::size_t i = 1; i < order.size(); ++i) pairs += is_pair(i) ? 1 : 0;
  EXPECT_EQ(pairs, 8 - 1 - 4);
}

TEST(FaceInterleaving, OfOneFaceIsThatFace) {
  std::mt19937 chance(1);
  EXPECT_EQ(interleaved({0, 0, 0}, chance), (std::vector{0, 0, 0}));
}

TEST(FaceInterleaving, FaultsAreFacesThatFollowThemselvesAndThoseAhead) {
  EXPECT_EQ(interleaving_violations(std::vector{0, 1, 0, 1}), 0);
  EXPECT_EQ(interleaving_violations(std::vector{0, 0, 1, 1}), 2);
  // Face 0 is 2.5 ahead of its half with its fifth touch, and 3 with its sixth.
  EXPECT_EQ(interleaving_violations(faces_with({6, 6})), 10 + 2);
  EXPECT_EQ(interleaving_violations({}), 0);
}

}  // namespace
}  // namespace calib
