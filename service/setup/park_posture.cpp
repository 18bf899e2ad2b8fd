#include "service/setup/park_posture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "calib_core/geometry/units.hpp"

namespace cell {
namespace {

/// Beside what the arm may miss: a plan's paths start here.
constexpr double kParkRoomMetres = 0.05;
constexpr int kParkDraws = 20'000;
constexpr std::uint64_t kParkSeed = 1;     // the same posture for the same cell
constexpr double kParkHeightMetres = 0.3;  // of the ball over the block

/// Postures of the shipped cells, which suit arms of their build.
constexpr std::array<std::array<double, 6>, 2> kKnownParksDeg{
    {{0.0, 0.0, 60.0, 0.0, 90.0, 0.0}, {0.0, 0.0, 60.0, 0.0, 45.0, 0.0}}};

std::optional<calib::Clash> clash_at(const Cell& scene, const calib::CollisionScene& around,
                                     const calib::PreparedModel& model, const calib::JointVector& joints,
                                     double room_m) {
  return calib::find_clash(around, calib::forward_chain(model, joints),
                           room_m + scene.nominal_position_error_m);
}

/// y is down.
double top_of(const Cell& scene) {
  return scene.block.solids.empty() ? 0.0 : scene.block.solids.front().min_m.y();
}

/// Where the arm waits best: over the block, looking at it, far from the ends of its ranges. Smaller is
/// better.
double cost(const Cell& scene, const calib::Chain& chain, const calib::JointVector& joints) {
  const Eigen::Vector3d wanted_m(0.0, top_of(scene) - kParkHeightMetres, 0.0);
  const Eigen::Vector3d stylus = chain.block_from_frame.back().linear().col(2);
  const calib::JointVector middle = 0.5 * (scene.arm.joint_ranges.lower + scene.arm.joint_ranges.upper);
  return (chain.tip_in_block_m() - wanted_m).norm() + 0.5 * (1.0 - stylus.y()) +
         0.05 * (joints - middle).norm();
}

calib::JointVector drawn(const calib::JointRanges& ranges, std::mt19937_64& chance) {
  std::uniform_real_distribution<double> share(0.05, 0.95);
  calib::JointVector joints;
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    // Whole turns more say nothing new.
    const double lower = std::max(ranges.lower[joint], -std::numbers::pi);
    const double upper = std::min(ranges.upper[joint], std::numbers::pi);
    const bool is_within = lower < upper;
    const double from = is_within ? lower : ranges.lower[joint], to = is_within ? upper : ranges.upper[joint];
    const double degrees = std::round((from + share(chance) * (to - from)) / calib::kRadiansPerDegree);
    joints[joint] = std::clamp(calib::kRadiansPerDegree * degrees, ranges.lower[joint], ranges.upper[joint]);
  }
  return joints;
}

std::optional<calib::JointVector> park_posture_with(const Cell& scene, double room_m) {
  const calib::CollisionScene around = scene.collision_scene();
  const calib::PreparedModel model = calib::prepare(scene.arm.model);
  for (const auto& degrees : kKnownParksDeg) {
    calib::JointVector joints = calib::kRadiansPerDegree * calib::JointVector(degrees.data());
    const calib::Chain chain = calib::forward_chain(model, joints);
    const bool looks_down =
        chain.block_from_frame.back().linear().col(2).y() > 0.5 && chain.tip_in_block_m().y() < top_of(scene);
    if (looks_down && scene.arm.joint_ranges.contains(joints) &&
        !clash_at(scene, around, model, joints, room_m))
      return joints;
  }
  std::optional<calib::JointVector> best;
  double least = std::numeric_limits<double>::infinity();
  std::mt19937_64 chance(kParkSeed);
  for (int i = 0; i < kParkDraws; ++i) {
    const calib::JointVector joints = drawn(scene.arm.joint_ranges, chance);
    const double here = cost(scene, calib::forward_chain(model, joints), joints);
    if (here >= least || clash_at(scene, around, model, joints, room_m)) continue;
    best = joints;
    least = here;
  }
  return best;
}

}  // namespace

double reach_of(const calib::KinematicModel& model) {
  double reach_m = 0.0;
  for (std::size_t frame = 2; frame < model.links.size(); ++frame)
    reach_m += std::hypot(model.links[frame].d_m, model.links[frame].r_m);
  return reach_m;
}

std::optional<calib::Clash> park_clash(const Cell& scene) {
  return clash_at(scene, scene.collision_scene(), calib::prepare(scene.arm.model), scene.park_joints, 0.0);
}

std::optional<ParkObstruction> park_obstruction(const Cell& scene) {
  const calib::CollisionScene around = scene.collision_scene();
  const calib::PreparedModel model = calib::prepare(scene.arm.model);
  std::map<std::pair<std::string, std::string>, int> counts;
  std::mt19937_64 chance(kParkSeed);
  for (int i = 0; i < kParkDraws; ++i) {
    const auto clash = clash_at(scene, around, model, drawn(scene.arm.joint_ranges, chance), 0.0);
    if (!clash) return std::nullopt;
    ++counts[{clash->body, clash->other}];
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
  return ParkObstruction{.body = most->first.first,
                         .other = most->first.second,
                         .share = most->second / static_cast<double>(kParkDraws)};
}

calib::JointVector find_park_posture(const Cell& scene) {
  for (const double room_m : {kParkRoomMetres, 0.0})
    if (const auto joints = park_posture_with(scene, room_m)) return *joints;
  return 0.5 * (scene.arm.joint_ranges.lower + scene.arm.joint_ranges.upper);
}

}  // namespace cell
