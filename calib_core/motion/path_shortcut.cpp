#include "calib_core/motion/path_shortcut.hpp"

#include <cstddef>

#include "calib_core/motion/transfer_path.hpp"

namespace calib {
namespace {

/// A posture is drawn by half of its way, a quarter and so on: each costs two looks at moves.
constexpr int kDrawsMax = 3;

JointVector draw(const WayJudge& judge, const JointVector& before, const JointVector& loose,
                 const JointVector& behind) {
  const JointVector whole = nearest_on_move(before, behind, loose) - loose;
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
