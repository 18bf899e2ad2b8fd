#include "calib_core/motion/transfer_path.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace calib {
namespace {

/// The joints, counted from 0, that a raised posture takes from the park posture.
const std::vector<std::vector<int>> kRaisingJoints{{1, 2}, {2}, {1}};

std::vector<JointVector> raised_postures(const TransferSpace& space, const JointVector& joints) {
  std::vector<JointVector> raised;
  for (const auto& moved : kRaisingJoints) {
    JointVector posture = joints;
    for (const int joint : moved) posture[joint] = space.park_joints()[joint];
    raised.push_back(posture);
  }
  return raised;
}

using Path = std::vector<std::size_t>;  // indices of postures, both ends included

/// Sum over the moves of the largest joint motion.
double travel_rad(const std::vector<JointVector>& postures, const Path& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    sum += (postures[path[i]] - postures[path[i - 1]]).cwiseAbs().maxCoeff();
  }
  return sum;
}

/// Paths from posture 0 to posture 1. Posture 2 is park; then come the raised postures of 0 and those of 1.
std::vector<Path> candidate_paths(std::size_t raised_count) {
  std::vector<Path> paths;
  for (std::size_t out = 0; out <= raised_count; ++out) {
    for (std::size_t in = 0; in <= raised_count; ++in) {
      for (const bool through_park : {false, true}) {
        Path path{0};
        if (out > 0) path.push_back(2 + out);
        if (through_park) path.push_back(2);
        if (in > 0) path.push_back(2 + raised_count + in);
        path.push_back(1);
        paths.push_back(std::move(path));
      }
    }
  }
  return paths;
}

}  // namespace

std::optional<std::vector<JointVector>> find_path(const TransferSpace& space, const JointVector& from,
                                                  const JointVector& to) {
  std::vector<JointVector> postures{from, to, space.park_joints()};
  for (const JointVector& end : {from, to}) {
    for (const JointVector& raised : raised_postures(space, end)) postures.push_back(raised);
  }
  std::vector<Path> paths = candidate_paths(kRaisingJoints.size());
  std::ranges::stable_sort(paths, {}, [&](const Path& path) { return travel_rad(postures, path); });

  std::map<std::pair<std::size_t, std::size_t>, bool> known;
  const auto move_is_clear = [&](std::size_t a, std::size_t b) {
    const auto [entry, is_new] = known.try_emplace({a, b}, false);
    if (is_new) entry->second = space.is_clear(postures[a], postures[b]);
    return entry->second;
  };
  for (const Path& path : paths) {
    bool clear = true;
    for (std::size_t i = 1; clear && i < path.size(); ++i) clear = move_is_clear(path[i - 1], path[i]);
    if (!clear) continue;
    std::vector<JointVector> between;
    for (std::size_t i = 1; i + 1 < path.size(); ++i) between.push_back(postures[path[i]]);
    return between;
  }
  return std::nullopt;
}

std::vector<JointVector> whole_path(const JointVector& from, const std::vector<JointVector>& via,
                                    const JointVector& to) {
  std::vector<JointVector> path{from};
  path.insert(path.end(), via.begin(), via.end());
  path.push_back(to);
  return path;
}

JointVector nearest_on_move(const JointVector& from, const JointVector& to, const JointVector& joints) {
  const JointVector move = to - from;
  const double length_squared = move.squaredNorm();
  if (length_squared == 0.0) return from;
  return from + std::clamp((joints - from).dot(move) / length_squared, 0.0, 1.0) * move;
}

bool can_reach_park(const TransferSpace& space, const JointVector& joints) {
  for (const JointVector& raised : raised_postures(space, joints)) {
    if (space.is_clear(joints, raised) && space.is_clear(raised, space.park_joints())) return true;
  }
  return space.is_clear(joints, space.park_joints());
}

}  // namespace calib
