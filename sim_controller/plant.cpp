#include "sim_controller/plant.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib_core/estimation/block_registration.hpp"
#include "config/moved_cell.hpp"
#include "config/place_cell.hpp"
#include "config/probe_tips_file.hpp"
#include "config/true_places.hpp"
#include "config/true_tips.hpp"

namespace sim {
namespace {

bool is_stylus_ball(const calib::Capsule& body) {
  return body.frame == calib::kFrameCount - 1 && body.from_m.isZero() && body.to_m.isZero();
}

/// The balls of the further tips where they really are; by the drawing they are no bodies any more.
void take_tips(const cell::Cell& cell, const cell::Truth& truth, double pretravel_m, Plant& plant) {
  for (const cell::ProbeTip& tip : cell.probe.tips)
    std::erase_if(plant.scene.bodies, [&tip](const auto& body) { return cell::is_ball_of(tip, body); });
  for (const cell::ProbeTip& tip : cell::true_tips(truth, cell.probe))
    plant.tips.push_back({.center_m = tip.center_m, .trip_distance_m = tip.radius_m - pretravel_m});
}

/// The plant at the first place, after the block went to `first_from_place`.
Plant with_block_at(const Plant& first, const cell::Block& block, const Eigen::Isometry3d& first_from_place) {
  Plant there = first;
  calib::set_block_pose(there.truth, first_from_place.inverse() * calib::block_pose_of(first.truth));
  const std::vector<bool> moves = cell::solids_that_move(block);
  const std::vector<calib::Box>& before = first.scene.obstacles;  // the block's solids come first
  std::vector<calib::Box> moving, standing;
  for (std::size_t i = 0; i < before.size(); ++i)
    (i < moves.size() && moves[i] ? moving : standing).push_back(before[i]);
  there.scene.obstacles = std::move(moving);
  const std::vector<calib::Box> after = cell::boxes_after_move(standing, first_from_place);
  there.scene.obstacles.insert(there.scene.obstacles.end(), after.begin(), after.end());
  return there;
}

}  // namespace

Plant make_plant(const cell::Cell& cell, const cell::Truth& truth) {
  Plant plant;
  plant.arm_name = cell.arm.name;
  plant.arm_serial = cell.arm_serial.value_or("");
  plant.nominal = cell.arm.model;
  plant.truth = cell::true_model(truth, cell.arm);
  plant.joint_ranges = cell.arm.joint_ranges;
  plant.joint_speeds_max = cell.arm.joint_speeds_max;
  plant.start_joints = cell.park_joints;
  plant.scene = cell.collision_scene();
  std::erase_if(plant.scene.bodies, is_stylus_ball);
  std::ranges::copy(cell::true_solids(truth, cell.block), plant.scene.obstacles.begin());
  const double pretravel_m = truth.probe.pretravel_m.value_or(cell.probe.stylus.pretravel_m);
  plant.trip_distance_m = truth.probe.stylus_radius_m.value_or(cell.probe.stylus.radius_m) - pretravel_m;
  take_tips(cell, truth, pretravel_m, plant);
  plant.overtravel_m = cell.probe.overtravel_m;
  plant.touch_noise_m = truth.probe.noise_m.value_or(cell.touch_noise_m);
  plant.hidden = truth;
  return plant;
}

Plant make_plant(const cell::Cell& cell, const calib::ErrorVector& errors) {
  return make_plant(cell, cell::Truth{.errors = errors});
}

PlantByPlace make_plants(const cell::Cell& cell, const cell::Truth& truth) {
  const Plant first = make_plant(cell, truth);
  PlantByPlace plants{{cell::kFirstPlace, first}};
  const std::vector<Eigen::Isometry3d> poses = cell::true_places(truth, cell.block);
  for (std::size_t i = 0; i < poses.size(); ++i)
    plants.emplace(cell.block.places[i].name, with_block_at(first, cell.block, poses[i]));
  return plants;
}

double stopping_distance_m(double speed_m_s, double latency_s) {
  return speed_m_s * latency_s + speed_m_s * speed_m_s / (2.0 * kAccelerationMetresPerSecond2);
}

double search_speed_max_m_s(double overtravel_m) {
  // v t + v^2 / 2a = overtravel / 2, solved for v.
  const double t = kStopLatencySeconds;
  const double a = kAccelerationMetresPerSecond2;
  return a * (std::sqrt(t * t + overtravel_m / a) - t);
}

}  // namespace sim
