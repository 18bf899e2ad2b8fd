#include "calib_core/motion/path_shortcut.hpp"

#include <cstddef>

#include "calib_core/motion/transfer_path.hpp"

namespace calib {
namespace {

/// A posture is moved by a half, a quarter and so on of its distance; each try checks two moves.
constexpr int kTriesMax = 3;

JointVector move_closer(const MoveCriteria& criteria, const JointVector& before, const JointVector& posture,
                        const JointVector& after) {
  const JointVector whole = nearest_on_move(before, after, posture) - posture;
  JointVector moved = posture;
  double step = 0.5;
  for (int i = 0; i < kTriesMax; ++i, step /= 2.0) {
    const JointVector tried = moved + step * whole;
    if (criteria.is_clear(before, tried) && criteria.is_clear(tried, after)) moved = tried;
  }
  return moved;
}

double path_s(const MoveCriteria& criteria, const std::vector<JointVector>& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += criteria.seconds(path[i - 1], path[i]);
  return sum;
}

}  // namespace

std::vector<JointVector> shortcut_path(const MoveCriteria& criteria, const std::vector<JointVector>& path) {
  if (path.size() < 3) return path;
  std::vector<JointVector> shorter{path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    if (criteria.is_clear(shorter.back(), path[i + 1])) continue;
    shorter.push_back(move_closer(criteria, shorter.back(), path[i], path[i + 1]));
  }
  shorter.push_back(path.back());
  return path_s(criteria, shorter) < path_s(criteria, path) ? shorter : path;
}

}  // namespace calib
