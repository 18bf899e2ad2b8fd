#include "sim_controller/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

namespace sim {
namespace {

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

/// Unit vector from the box's nearest point to a point outside; inside, out through the nearest side.
Eigen::Vector3d outward(const calib::Box& box, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d way = point_m - point_m.cwiseMax(box.min_m).cwiseMin(box.max_m);
  if (!way.isZero(0.0)) return way.normalized();
  const Eigen::Vector3d below = box.min_m - point_m, above = point_m - box.max_m;
  int axis = 0;
  below.cwiseMax(above).maxCoeff(&axis);
  return above[axis] > below[axis] ? Eigen::Vector3d::Unit(axis).eval()
                                   : (-Eigen::Vector3d::Unit(axis)).eval();
}

/// Pre-travel beside that of a push along the stylus; `push` on the ball in R_7, a unit vector.
double sideways_pretravel_m(const cell::TrueProbe& probe, const Eigen::Vector3d& push) {
  if (probe.pretravel_tilt_m == 0.0 && probe.lobes_m == 0.0) return 0.0;
  const double direction_rad = std::atan2(push.y(), push.x());
  return push.head<2>().squaredNorm() *
         (probe.pretravel_tilt_m +
          probe.lobes_m * std::cos(3.0 * (direction_rad - probe.lobe_direction_rad)));
}

}  // namespace

double box_distance_m(const calib::Box& box, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d outside = (box.min_m - point_m).cwiseMax(point_m - box.max_m);
  const double deepest = outside.maxCoeff();
  return deepest <= 0.0 ? deepest : outside.cwiseMax(0.0).norm();
}

double trip_gap_m(const Plant& plant, const calib::JointVector& joints, double noise_m) {
  const Eigen::Vector3d ball = calib::forward_kinematics(plant.truth, joints).translation();
  double distance_m = std::numeric_limits<double>::infinity();
  for (const calib::Box& box : plant.scene.obstacles)
    distance_m = std::min(distance_m, box_distance_m(box, ball));
  return distance_m - (plant.trip_distance_m + noise_m);
}

double trip_gap_m(const Plant& plant, const Eigen::Isometry3d& block_from_tool, double noise_m) {
  const Eigen::Vector3d ball = block_from_tool.translation();
  double gap_m = std::numeric_limits<double>::infinity();
  for (const calib::Box& box : plant.scene.obstacles) {
    const Eigen::Vector3d push = block_from_tool.linear().transpose() * outward(box, ball);
    const double trip_distance_m =
        plant.trip_distance_m + noise_m - sideways_pretravel_m(plant.hidden.probe, push);
    gap_m = std::min(gap_m, box_distance_m(box, ball) - trip_distance_m);
  }
  return gap_m;
}

Room room_around(const calib::CollisionScene& scene, const calib::Chain& chain, int yielding) {
  std::vector<calib::Segment> placed;
  placed.reserve(scene.bodies.size());
  double way_m = std::numeric_limits<double>::infinity();
  const std::string *nearest = nullptr, *to = nullptr;
  const auto consider = [&](double pair_way_m, const std::string& body, const std::string& other) {
    if (pair_way_m >= way_m) return;
    way_m = pair_way_m;
    nearest = &body;
    to = &other;
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const calib::Capsule& body = scene.bodies[i];
    const calib::Segment& here = placed.emplace_back(calib::place(body, chain));
    if (static_cast<int>(i) == yielding) continue;
    for (const calib::Box& obstacle : scene.obstacles) {
      consider(calib::segment_box_distance_m(here, obstacle) - body.radius_m, body.name, obstacle.name);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const calib::Capsule& other = scene.bodies[j];
      if (calib::are_neighbours(body, other)) continue;
      const double apart_m =
          calib::segment_distance_m(here.from_m, here.to_m, placed[j].from_m, placed[j].to_m) -
          body.radius_m - other.radius_m;
      consider(0.5 * apart_m, body.name, other.name);  // both move
    }
  }
  if (way_m > 0.0) return {way_m, ""};
  return {way_m, *nearest + " hit " + *to};
}

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

}  // namespace sim
