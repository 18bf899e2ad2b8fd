#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "aimed_touch.hpp"
#include "sim_controller/drives.hpp"
#include "sim_controller/world.hpp"

namespace sim::testing {

/// sense(), which must see the same as a world that looks at every step, and not only where something may be
/// near.
inline Sensed sense_as_by_looking(const Plant& plant, World& world, const TickMotion& motion) {
  World looking = world;
  looking.to_edge_m = looking.to_hit_m = -1.0;
  looking.tip_levers_m.setConstant(1e9);  // at every step, not only at the first: no way is known to be free
  const Sensed expected = sense(plant, looking, motion), seen = sense(plant, world, motion);
  EXPECT_EQ(seen.inputs, expected.inputs);
  EXPECT_EQ(seen.edge_share, expected.edge_share);
  EXPECT_EQ(seen.edges, expected.edges);
  EXPECT_EQ(seen.collision, expected.collision);
  return seen;
}

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
