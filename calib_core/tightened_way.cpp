#include "calib_core/tightened_way.hpp"

#include <algorithm>
#include <cstddef>

namespace calib {
namespace {

/// A posture is drawn by half of its way, a quarter and so on: each costs two looks at moves.
constexpr int kDrawsMax = 3;

/// The posture's nearest place on the straight move between its neighbours.
JointVector straight_between(const JointVector& before, const JointVector& posture,
                             const JointVector& behind) {
  const JointVector move = behind - before;
  const double length2 = move.squaredNorm();
  if (length2 == 0.0) return before;
  return before + std::clamp((posture - before).dot(move) / length2, 0.0, 1.0) * move;
}

JointVector draw(const WayJudge& judge, const JointVector& before, const JointVector& loose,
                 const JointVector& behind) {
  const JointVector whole = straight_between(before, loose, behind) - loose;
  JointVector drawn = loose;
  double step = 0.5;
  for (int i = 0; i < kDrawsMax; ++i, step /= 2.0) {
    const JointVector tried = drawn + step * whole;
    if (judge.is_clear(before, tried) && judge.is_clear(tried, behind)) drawn = tried;
  }
  return drawn;
}

double way_s(const WayJudge& judge, const std::vector<JointVector>& way) {
  double sum = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += judge.seconds(way[i - 1], way[i]);
  return sum;
}

}  // namespace

std::vector<JointVector> tighten_way(const WayJudge& judge, const std::vector<JointVector>& way) {
  if (way.size() < 3) return way;
  std::vector<JointVector> tight{way.front()};
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    if (judge.is_clear(tight.back(), way[i + 1])) continue;
    tight.push_back(draw(judge, tight.back(), way[i], way[i + 1]));
  }
  tight.push_back(way.back());
  return way_s(judge, tight) < way_s(judge, way) ? tight : way;
}

}  // namespace calib
