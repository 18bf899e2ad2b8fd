#include "sim_controller/plant.hpp"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

bool is_stylus_ball(const calib::Capsule& body) {
  return body.frame == calib::kFrameCount - 1 && body.from_m.isZero() && body.to_m.isZero();
}

}  // namespace

Plant make_plant(const cell::Cell& cell, const calib::ErrorVector& errors) {
  Plant plant;
  plant.arm_name = cell.arm.name;
  plant.nominal = cell.arm.model;
  plant.truth = calib::apply(cell.arm.model, errors);
  plant.joint_ranges = cell.arm.joint_ranges;
  plant.joint_speeds_max = cell.arm.joint_speeds_max;
  plant.start_joints = cell.park_joints;
  plant.scene = cell.collision_scene();
  std::erase_if(plant.scene.bodies, is_stylus_ball);
  plant.trip_distance_m = cell.probe.stylus.radius_m - cell.probe.stylus.pretravel_m;
  plant.overtravel_m = cell.probe.overtravel_m;
  plant.touch_noise_m = cell.touch_noise_m;
  return plant;
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
