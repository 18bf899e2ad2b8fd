#include "tests/sim_controller/whole_path.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <variant>

namespace sim::testing {

double trip_gap_m(const Plant& plant, const calib::JointVector& joints, double noise_m) {
  const Eigen::Vector3d ball = calib::forward_kinematics(plant.truth, joints).translation();
  double distance_m = std::numeric_limits<double>::infinity();
  for (const calib::Box& box : plant.scene.obstacles)
    distance_m = std::min(distance_m, box_distance_m(box, ball));
  return distance_m - (plant.trip_distance_m + noise_m);
}

namespace {

/// The path is looked at every so much of the ball's way at most; a graze with a shorter chord may be missed.
constexpr double kContactStepMetres = 0.25e-3;
/// The trip is found to this much of the ball's way.
constexpr double kContactPrecisionMetres = 1e-9;

/// How far every body may go from this posture before anything can touch, at least kCollisionStepMetres; or
/// what touches already. Steps are bounded because find_clash knows a clearance from obstacles only.
std::variant<double, calib::Clash> free_way_m(const Plant& plant, const calib::JointVector& joints) {
  static constexpr std::array kClearancesMetres{0.03, 0.008};
  const calib::Chain chain = calib::forward_chain(plant.truth, joints);
  for (const double clearance_m : kClearancesMetres) {
    if (!calib::find_clash(plant.scene, chain, clearance_m)) return clearance_m;
  }
  if (auto clash = calib::find_clash(plant.scene, chain, 0.0)) return *clash;
  return kCollisionStepMetres;
}

/// The touched end of the edge between two shares of one segment, the first free and the second touched.
double bisect_trip(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to,
                   double noise_m, double free, double touched, double bound_m) {
  while ((touched - free) * bound_m > kContactPrecisionMetres) {
    const double middle = 0.5 * (free + touched);
    (trip_gap_m(plant, from + middle * (to - from), noise_m) > 0.0 ? free : touched) = middle;
  }
  return touched;
}

}  // namespace

std::optional<double> find_trip(const Plant& plant, const Path& path, double noise_m) {
  double gap_m = trip_gap_m(plant, path.front(), noise_m);
  if (gap_m <= 0.0) return 0.0;
  const auto segments = static_cast<double>(path.size() - 1);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const calib::JointVector& from = path[i];
    const calib::JointVector& to = path[i + 1];
    const double bound_m = sweep_bound_m(plant, from, to);
    for (double free = 0.0; free < 1.0;) {
      // The ball cannot meet anything within the gap: go as far as it allows.
      const double next = std::min(1.0, free + std::max(gap_m, kContactStepMetres) / bound_m);
      gap_m = trip_gap_m(plant, from + next * (to - from), noise_m);
      if (gap_m <= 0.0) {
        const double share = bisect_trip(plant, from, to, noise_m, free, next, bound_m);
        return (static_cast<double>(i) + share) / segments;
      }
      free = next;
    }
  }
  return std::nullopt;
}

std::optional<Hit> find_hit(const Plant& plant, const Path& path, double until) {
  const auto segments = static_cast<double>(path.size() - 1);
  double way_m = 0.0;  // that is known to be free
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double bound_m = sweep_bound_m(plant, path[i], path[i + 1]);
    const double end = std::min(1.0, until * segments - static_cast<double>(i));
    for (double share = 0.0; share < end;) {
      if (way_m <= 0.0) {
        const calib::JointVector joints = path[i] + share * (path[i + 1] - path[i]);
        const auto free = free_way_m(plant, joints);
        if (const auto* clash = std::get_if<calib::Clash>(&free)) {
          return Hit{(static_cast<double>(i) + share) / segments, *clash};
        }
        way_m = std::get<double>(free);
      }
      const double left_m = (end - share) * bound_m;
      const double step_m = std::min(way_m, left_m);
      share = way_m >= left_m ? end : share + step_m / bound_m;
      way_m -= step_m;
    }
  }
  const auto at_end = free_way_m(plant, posture(path, until));
  if (const auto* clash = std::get_if<calib::Clash>(&at_end)) return Hit{until, *clash};
  return std::nullopt;
}

}  // namespace sim::testing
