#include "tests/sim_controller/drive_runs.hpp"

#include <gtest/gtest.h>

namespace sim::testing {

const Plant& plant() {
  static const Plant plant = testing::perfect_plant("demo");
  return plant;
}

const TouchMotion& search() {
  static const TouchMotion motion =
      testing::aimed_touch(testing::read_cell("demo"), {.face = 0, .tilt_rad = 0.7}).motion;
  return motion;
}

double search_length_m() { return tip_distance_m(plant(), search().approach, search().search_end); }

Drives at_approach() { return {.joints = search().approach}; }

calib::JointVector random_joints(std::mt19937_64& chance) {
  calib::JointVector joints;
  for (int i = 0; i < calib::kJointCount; ++i) {
    const double share = static_cast<double>(chance() >> 11) * 0x1p-53;
    joints[i] = plant().joint_ranges.lower[i] +
                share * (plant().joint_ranges.upper[i] - plant().joint_ranges.lower[i]);
  }
  return joints;
}

std::vector<TickMotion> run(Drives& drives, double monitor_speed_percent) {
  std::vector<TickMotion> ticks;
  while (!drives.queue.empty() && ticks.size() < kTicksMax)
    ticks.push_back(tick(drives, monitor_speed_percent, true));
  EXPECT_TRUE(drives.queue.empty());
  return ticks;
}

double duration_s(const std::vector<TickMotion>& ticks) {
  return kTickSeconds * static_cast<double>(ticks.size());
}

double tip_speed_m_s(const TickMotion& tick) {
  return tip_distance_m(plant(), tick.from, tick.to) / kTickSeconds;
}

OnLine on_search_line(const calib::JointVector& joints) {
  const Eigen::Vector3d start = tip_m(plant().nominal, search().approach);
  const Eigen::Vector3d way = tip_m(plant().nominal, search().search_end) - start;
  const Eigen::Vector3d here = tip_m(plant().nominal, joints) - start;
  const double along_m = here.dot(way.normalized());
  return {(here - along_m * way.normalized()).norm(), along_m};
}

std::vector<TickMotion> brake(Drives& drives) {
  std::vector<TickMotion> ticks;
  reset_motion(drives);
  while (drives.braking && ticks.size() < kTicksMax) ticks.push_back(tick(drives, 100.0, true));
  EXPECT_FALSE(drives.braking);
  return ticks;
}

}  // namespace sim::testing
