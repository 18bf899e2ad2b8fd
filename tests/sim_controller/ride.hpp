#pragma once

#include <algorithm>
#include <random>

#include "aimed_touch.hpp"
#include "sim_controller/drives.hpp"
#include "sim_controller/world.hpp"

namespace sim::testing {

/// An arm, its drives and the world around them, without a controller: moves as they come, tick by tick.
struct Ride {
  explicit Ride(Plant on_plant, std::uint64_t seed = 1)
      : plant(std::move(on_plant)),
        drives{.joints = plant.start_joints},
        world(make_world(plant)),
        chance(seed) {}

  void put(const calib::JointVector& joints) { drives = Drives{.joints = joints}; }

  Sensed tick() {
    last = sim::tick(drives, 100.0, true);
    ++ticks;
    return sense(plant, world, last);
  }

  /// Searches along a straight line from where the arm is put; commanded joints at the first edge that the
  /// latch captured. The arm stops at once.
  std::optional<calib::JointVector> search(const calib::JointVector& from, const calib::JointVector& to,
                                           double speed_m_s = 0.008) {
    put(from);
    begin_search(plant, world, chance);
    movel(plant, drives, to, speed_m_s);
    while (!is_empty(drives)) {
      const Sensed seen = tick();
      edges += seen.edges;
      if (seen.collision) collision = *seen.collision;
      if (seen.edge_share) return last.at(*seen.edge_share);
    }
    return std::nullopt;
  }
  std::optional<calib::JointVector> search(const TouchMotion& motion) {
    return search(motion.approach, motion.search_end);
  }

  void go(const calib::JointVector& to, double speed_m_s) {
    movej(plant, drives, to, speed_m_s);
    while (!is_settled(drives) || !is_empty(drives)) tick();
  }

  Plant plant;
  Drives drives;
  World world;
  std::mt19937_64 chance;
  TickMotion last{};
  int ticks = 0;
  int edges = 0;
  std::string collision;
};

}  // namespace sim::testing
