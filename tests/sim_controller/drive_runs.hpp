#pragma once

#include <random>
#include <vector>

#include "sim_controller/drives.hpp"
#include "tests/sim_controller/aimed_touch.hpp"

/// Drives that run until they stand, and what happened on the way.
namespace sim::testing {

inline constexpr int kTicksMax = 100'000;
/// A move's end, and a peak that lies inside a tick, cost up to a tick each.
inline constexpr double kTwoTicksSeconds = 2.0 * kTickSeconds;

const Plant& plant();

/// A search down to a face of the demo cell: 30 mm.
const TouchMotion& search();
double search_length_m();

Drives at_approach();

calib::JointVector random_joints(std::mt19937_64& chance);

/// Ticks until the queue is empty; what happened in them.
std::vector<TickMotion> run(Drives& drives, double monitor_speed_percent = 100.0);
double duration_s(const std::vector<TickMotion>& ticks);
double tip_speed_m_s(const TickMotion& tick);

/// Distance from the search's line, and how far along it.
struct OnLine {
  double off_m;
  double along_m;
};
OnLine on_search_line(const calib::JointVector& joints);

/// A reset of the motion, and what happens in each tick until the arm stands.
std::vector<TickMotion> brake(Drives& drives);

}  // namespace sim::testing
