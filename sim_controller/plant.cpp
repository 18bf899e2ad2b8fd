#include "sim_controller/plant.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

bool is_stylus_ball(const calib::Capsule& body) {
  return body.frame == calib::kFrameCount - 1 && body.from_m.isZero() && body.to_m.isZero();
}

}  // namespace

Plant make_plant(const cell::Cell& cell, const cell::Truth& truth) {
  Plant plant;
  plant.arm_name = cell.arm.name;
  plant.nominal = cell.arm.model;
  plant.truth = cell::true_model(truth, cell.arm);
  plant.joint_ranges = cell.arm.joint_ranges;
  plant.joint_speeds_max = cell.arm.joint_speeds_max;
  plant.start_joints = cell.park_joints;
  plant.scene = cell.collision_scene();
  std::erase_if(plant.scene.bodies, is_stylus_ball);
  std::ranges::copy(cell::true_solids(truth, cell.block), plant.scene.obstacles.begin());
  plant.trip_distance_m = truth.probe.stylus_radius_m.value_or(cell.probe.stylus.radius_m) -
                          truth.probe.pretravel_m.value_or(cell.probe.stylus.pretravel_m);
  plant.overtravel_m = cell.probe.overtravel_m;
  plant.touch_noise_m = truth.probe.noise_m.value_or(cell.touch_noise_m);
  plant.hidden = truth;
  return plant;
}

Plant make_plant(const cell::Cell& cell, const calib::ErrorVector& errors) {
  return make_plant(cell, cell::Truth{.errors = errors});
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
