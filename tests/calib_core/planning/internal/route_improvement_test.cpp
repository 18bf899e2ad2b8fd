#include "calib_core/planning/internal/route_improvement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "calib_core/planning/internal/face_interleaving.hpp"

namespace calib {
namespace {

/// Stops on a circle, in a drawn order; the last one is where the way begins and ends.
struct Circle {
  Eigen::MatrixXd seconds;
  std::vector<int> faces;
  std::vector<std::size_t> order;

  explicit Circle(std::size_t count, int face_count) : seconds(index(count), index(count)), faces(count) {
    std::vector<double> turns(count);
    std::iota(turns.begin(), turns.end(), 0.0);
    std::mt19937 chance(1);
    std::shuffle(turns.begin(), turns.end() - 1, chance);
    for (std::size_t a = 0; a < count; ++a) {
      faces[a] = a + 1 < count ? static_cast<int>(turns[a]) % face_count : -1;
      for (std::size_t b = 0; b < count; ++b) {
        const double half_turn = std::numbers::pi / static_cast<double>(count);
        seconds(index(a), index(b)) = 2.0 * std::abs(std::sin((turns[a] - turns[b]) * half_turn));
      }
    }
    order.push_back(count - 1);
    for (std::size_t i = 0; i + 1 < count; ++i) order.push_back(i);
    order.push_back(count - 1);
  }

  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  [[nodiscard]] RouteProblem problem() const { return {seconds, faces}; }
  [[nodiscard]] std::vector<int> faces_in_order() const {
    std::vector<int> touched;
    for (std::size_t i = 1; i + 1 < order.size(); ++i) touched.push_back(faces[order[i]]);
    return touched;
  }
};

TEST(ShortWay, AroundACircleIsTheCircle) {
  constexpr std::size_t kStops = 40;
  Circle circle(kStops, 1);
  improve_route(circle.problem(), circle.order, 1, 1, kStops);
  EXPECT_NEAR(route_time_s(circle.problem(), circle.order),
              2.0 * kStops * std::sin(std::numbers::pi / kStops), 1e-9);
}

TEST(ShortWay, KeepsTheStopsAroundAndAllOfItsOwn) {
  Circle circle(30, 1);
  const std::vector<std::size_t> given = circle.order;
  improve_route(circle.problem(), circle.order, 1, 10, 20);
  EXPECT_LT(route_time_s(circle.problem(), circle.order), route_time_s(circle.problem(), given));
  for (std::size_t i = 0; i < given.size(); ++i) {
    const bool is_around = i < 10 || i >= 20;
    EXPECT_TRUE(!is_around || circle.order[i] == given[i]) << i;
  }
  EXPECT_TRUE(std::is_permutation(given.begin(), given.end(), circle.order.begin()));
}

TEST(ShortWay, DoesNotMakeTheFacesLessInterleaved) {
  Circle circle(41, 4);
  std::vector<std::size_t> sorted(circle.order.begin() + 1, circle.order.end() - 1);
  std::ranges::stable_sort(sorted, {}, [&](std::size_t stop) { return circle.faces[stop]; });
  for (std::size_t i = 0; i < sorted.size(); ++i) {  // faces in turn
    circle.order[i + 1] = sorted[(i % 4) * 10 + i / 4];
  }
  ASSERT_EQ(interleaving_violations(circle.faces_in_order()), 0);
  const double given_s = route_time_s(circle.problem(), circle.order);
  improve_route(circle.problem(), circle.order, 1, 1, 41);
  EXPECT_LT(route_time_s(circle.problem(), circle.order), 0.5 * given_s);
  EXPECT_EQ(interleaving_violations(circle.faces_in_order()), 0);
}

}  // namespace
}  // namespace calib
