#include "sim_controller/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {
namespace {

/// Unit vector from the box's nearest point to a point outside; inside, out through the nearest side.
Eigen::Vector3d out_of_box(const calib::Box& box, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d way = point_m - point_m.cwiseMax(box.min_m).cwiseMin(box.max_m);
  if (!way.isZero(0.0)) return way.normalized();
  const Eigen::Vector3d below = box.min_m - point_m, above = point_m - box.max_m;
  int axis = 0;
  below.cwiseMax(above).maxCoeff(&axis);
  return above[axis] > below[axis] ? Eigen::Vector3d::Unit(axis).eval()
                                   : (-Eigen::Vector3d::Unit(axis)).eval();
}

double whole_box_distance_m(const calib::Box& box, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d outside = (box.min_m - point_m).cwiseMax(point_m - box.max_m);
  const double deepest = outside.maxCoeff();
  return (deepest <= 0.0 ? deepest : outside.cwiseMax(0.0).norm()) - box.round_m;
}

/// The nearest surface of a solid: the distance from it, negative inside, and the direction out of it. In
/// front of the mouth of a hole the nearest point is on its rim.
struct NearSurface {
  double distance_m = 0.0;
  Eigen::Vector3d outward;
};

NearSurface near_surface(const calib::Box& box, const Eigen::Vector3d& point_m) {
  NearSurface near{whole_box_distance_m(box, point_m), out_of_box(box, point_m)};
  for (const calib::Hole& hole : box.holes) {
    const Eigen::Vector3d off_m = hole.off_axis_m(point_m);
    const double far_m = off_m.norm(), from_wall_m = hole.radius_m - far_m;
    const Eigen::Vector3d to_axis =
        far_m > 0.0 ? Eigen::Vector3d(-off_m / far_m) : hole.axis.unitOrthogonal();
    if (near.distance_m > 0.0 && from_wall_m > 0.0) {
      const Eigen::Vector3d from_rim_m = near.distance_m * near.outward + from_wall_m * to_axis;
      near = {from_rim_m.norm(), from_rim_m.normalized()};
    } else if (from_wall_m > near.distance_m) {
      near = {from_wall_m, to_axis};
    }
  }
  return near;
}

/// Pre-travel beside that of a push along the stylus; `push` on the ball in R_7, a unit vector.
double sideways_pretravel_m(const cell::TrueProbe& probe, const Eigen::Vector3d& push) {
  if (probe.pretravel_tilt_m == 0.0 && probe.lobes_m == 0.0) return 0.0;
  const double direction_rad = std::atan2(push.y(), push.x());
  return push.head<2>().squaredNorm() *
         (probe.pretravel_tilt_m +
          probe.lobes_m * std::cos(3.0 * (direction_rad - probe.lobe_direction_rad)));
}

/// trip_distance_m() of the ball that trips there when it is pushed along the stylus.
double tripping_at_m(const Plant& plant, double along_stylus_m, const Eigen::Isometry3d& block_from_tool,
                     const Eigen::Vector3d& outward, double noise_m) {
  const Eigen::Vector3d push = block_from_tool.linear().transpose() * outward;
  return along_stylus_m + noise_m - sideways_pretravel_m(plant.hidden.probe, push);
}

}  // namespace

double box_distance_m(const calib::Box& box, const Eigen::Vector3d& point_m) {
  return near_surface(box, point_m).distance_m;
}

double trip_distance_m(const Plant& plant, const Eigen::Isometry3d& block_from_tool,
                       const Eigen::Vector3d& outward, double noise_m) {
  return tripping_at_m(plant, plant.trip_distance_m, block_from_tool, outward, noise_m);
}

double trip_gap_m(const Plant& plant, const Eigen::Isometry3d& block_from_tool, double noise_m) {
  double gap_m = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Eigen::Vector3d& ball, double ball_trip_m) {
    for (const calib::Box& box : plant.scene.obstacles) {
      const NearSurface near = near_surface(box, ball);
      gap_m = std::min(
          gap_m, near.distance_m - tripping_at_m(plant, ball_trip_m, block_from_tool, near.outward, noise_m));
    }
  };
  consider(block_from_tool.translation(), plant.trip_distance_m);
  for (const TipBall& tip : plant.tips) consider(block_from_tool * tip.center_m, tip.trip_distance_m);
  return gap_m;
}

Room room_around(const calib::CollisionScene& scene, const calib::Chain& chain,
                 std::span<const int> yielding) {
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
    const calib::Segment& here = placed.emplace_back(calib::axis_in_block(body, chain));
    if (std::ranges::find(yielding, static_cast<int>(i)) != yielding.end()) continue;
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

}  // namespace sim
