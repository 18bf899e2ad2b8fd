#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/val3/bench.hpp"

/// Steps that several tests of the application's motion take.
namespace val3 {

using namespace cs8;

inline constexpr double kFaceMm = 8.0;

inline double apart_deg(const JointsMicrodeg& a, const JointsMicrodeg& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]) / 1e6);
  return most;
}

/// Depth of a posture below the approach posture, from its height in world.
inline double depth_mm(Bench& bench, const JointsMicrodeg& joints) {
  const Joint before = bench.cabinet.joints_deg;
  for (std::size_t i = 0; i < joints.size(); ++i) bench.cabinet.joints_deg[i] = joints[i] / 1e6;
  const double depth = bench.depth_mm();
  bench.cabinet.joints_deg = before;
  return depth;
}

/// Sends a touch with a number and takes Accepted.
inline void begin_touch(Bench& bench, std::uint32_t sequence, const Touch& touch) {
  bench.send(sequence, touch);
  bench.expect<Accepted>(sequence);
}

inline TouchResult finish_touch(Bench& bench, std::uint32_t sequence) {
  return bench.expect<TouchResult>(sequence, 30);
}

inline void run_until_depth(Bench& bench, double mm) {
  for (int left = 5000; bench.depth_mm() < mm && left > 0; --left) bench.ticks(1);
  EXPECT_GE(bench.depth_mm(), mm);
}

/// The way back is asked for and goes to the clear posture.
inline void expect_way_back(Bench& bench, std::uint32_t sequence) {
  bench.send(sequence, Retract{20000, 30000});
  bench.expect<Accepted>(sequence);
  EXPECT_EQ(bench.expect<MoveResult>(sequence, 10).outcome, Outcome::kArrived);
  EXPECT_NEAR(bench.depth_mm(), -20, 0.001);
}

}  // namespace val3
