#include "calib_core/motion/collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace calib {

Segment axis_in_block(const Capsule& body, const Chain& chain) {
  const Eigen::Isometry3d& block_from_frame = chain.block_from_frame[static_cast<std::size_t>(body.frame)];
  return {block_from_frame * body.from_m, block_from_frame * body.to_m};
}

Part part_near(const Segment& segment, const Box& box, double margin_m) {
  const Eigen::Vector3d span = segment.to_m - segment.from_m;
  Part part;
  for (int axis = 0; axis < 3; ++axis) {
    const double low_m = box.min_m[axis] - margin_m - segment.from_m[axis];
    const double high_m = box.max_m[axis] + margin_m - segment.from_m[axis];
    if (span[axis] == 0.0) {
      if (low_m >= 0.0 || high_m <= 0.0) return {1.0, 0.0};
      continue;
    }
    part.from = std::max(part.from, std::min(low_m / span[axis], high_m / span[axis]));
    part.to = std::min(part.to, std::max(low_m / span[axis], high_m / span[axis]));
  }
  return part;
}

namespace {

/// From the axis of the hole to the farthest point of the part of the segment beside the box: that is one of
/// its ends, as the distance from a line is convex. Nothing when no part of it is less than `margin_m` from
/// the box.
std::optional<Eigen::Vector3d> farthest_off_axis_m(const Segment& segment, const Box& box, const Hole& hole,
                                                   double margin_m) {
  const Part part = part_near(segment, box, margin_m);
  if (part.is_empty()) return std::nullopt;
  const Eigen::Vector3d span = segment.to_m - segment.from_m;
  const Eigen::Vector3d from_m = hole.off_axis_m(segment.from_m + part.from * span);
  const Eigen::Vector3d to_m = hole.off_axis_m(segment.from_m + part.to * span);
  return from_m.squaredNorm() > to_m.squaredNorm() ? from_m : to_m;
}

/// Whether every point of the segment is `distance_m` from the box along some axis or from the wall of the
/// hole: the material is in the box and outside the hole.
bool is_apart_in_hole(const Segment& segment, const Box& box, const Hole& hole, double distance_m) {
  const auto farthest_m = farthest_off_axis_m(segment, box, hole, distance_m);
  return !farthest_m || farthest_m->norm() <= hole.radius_m - distance_m;
}

/// The largest distance for which is_apart_in_hole() holds, as a gap; zero where that is no more than
/// `known_m`.
Eigen::Vector3d gap_in_hole_m(const Segment& segment, const Box& box, const Hole& hole, double known_m) {
  if (!(known_m < hole.radius_m) || !is_apart_in_hole(segment, box, hole, known_m))
    return Eigen::Vector3d::Zero();
  constexpr int kHalvings = 40;
  double apart_m = known_m, near_m = hole.radius_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = 0.5 * (apart_m + near_m);
    (is_apart_in_hole(segment, box, hole, middle_m) ? apart_m : near_m) = middle_m;
  }
  const auto farthest_m = farthest_off_axis_m(segment, box, hole, near_m);
  if (!farthest_m || farthest_m->isZero(0.0)) return apart_m * hole.axis.unitOrthogonal();
  return -apart_m * farthest_m->normalized();
}

Eigen::Vector3d segment_whole_box_gap_m(const Segment& segment, const Box& box) {
  const Eigen::Vector3d span = segment.to_m - segment.from_m;
  // Vector from the box to a point of the segment.
  const auto outside = [&](double t) -> Eigen::Vector3d {
    const Eigen::Vector3d point = segment.from_m + t * span;
    return point - point.cwiseMax(box.min_m).cwiseMin(box.max_m);
  };
  // Half the derivative of the squared distance: continuous, monotonic, and linear between the points where
  // the segment crosses one of the six planes of the box. Its root is the nearest point.
  const auto slope = [&](double t) { return outside(t).dot(span); };
  if (slope(0.0) >= 0.0) return outside(0.0);
  if (slope(1.0) <= 0.0) return outside(1.0);

  double before = 0.0, after = 1.0;
  double slope_before = slope(0.0), slope_after = slope(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (span[axis] == 0.0) continue;
    for (const double plane : {box.min_m[axis], box.max_m[axis]}) {
      const double t = (plane - segment.from_m[axis]) / span[axis];
      if (!(t > before && t < after)) continue;
      const double here = slope(t);
      (here < 0.0 ? before : after) = t;
      (here < 0.0 ? slope_before : slope_after) = here;
    }
  }
  const double nearest = before - slope_before * (after - before) / (slope_after - slope_before);
  return outside(nearest);
}

}  // namespace

Eigen::Vector3d segment_box_gap_m(const Segment& segment, const Box& box) {
  Eigen::Vector3d gap_m = segment_whole_box_gap_m(segment, box);
  for (const Hole& hole : box.holes) {
    const double known_m = gap_m.norm();
    const Eigen::Vector3d in_hole_m = gap_in_hole_m(segment, box, hole, known_m);
    if (in_hole_m.norm() > known_m) gap_m = in_hole_m;
  }
  return gap_m;
}

double segment_box_distance_m(const Segment& segment, const Box& box) {
  return std::max(segment_box_gap_m(segment, box).norm() - box.round_m, 0.0);
}

bool is_apart(const Segment& segment, const Box& box, double distance_m) {
  const double from_core_m = distance_m + box.round_m;
  const auto before = segment.from_m.cwiseMax(segment.to_m) - box.min_m;  // negative: entirely before the box
  const auto behind = segment.from_m.cwiseMin(segment.to_m) - box.max_m;
  if (std::max(behind.maxCoeff(), -before.minCoeff()) >= from_core_m) return true;
  if (segment_whole_box_gap_m(segment, box).norm() >= from_core_m) return true;
  return std::ranges::any_of(
      box.holes, [&](const Hole& hole) { return is_apart_in_hole(segment, box, hole, distance_m); });
}

double capsule_box_distance_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double radius_m,
                              const Box& box) {
  return segment_box_distance_m({from_m, to_m}, box) - radius_m;
}

double segment_distance_m(const Eigen::Vector3d& from_a, const Eigen::Vector3d& to_a,
                          const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_b) {
  const Eigen::Vector3d a = to_a - from_a, b = to_b - from_b, apart = from_a - from_b;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  const auto along = [](double numerator, double length_squared) {
    return length_squared > 0.0 ? std::clamp(numerator / length_squared, 0.0, 1.0) : 0.0;
  };
  // The common perpendicular of the lines, clamped to a; then the nearest point of b; then that of a again.
  const double determinant = aa * bb - ab * ab;
  const double first =
      determinant > 0.0 ? std::clamp((ab * apart.dot(b) - bb * apart.dot(a)) / determinant, 0.0, 1.0) : 0.0;
  const double on_b = along((apart + first * a).dot(b), bb);
  const double on_a = along((on_b * b - apart).dot(a), aa);
  return (apart + on_a * a - on_b * b).norm();
}

bool is_apart(const Segment& a, const Segment& b, double distance_m) {
  // Bounding spheres: both sides of the comparison are twice the distance.
  const double lengths_m = (a.to_m - a.from_m).norm() + (b.to_m - b.from_m).norm();
  const double needed_m = lengths_m + 2.0 * distance_m;
  if ((a.from_m + a.to_m - b.from_m - b.to_m).squaredNorm() >= needed_m * needed_m) return true;
  return segment_distance_m(a.from_m, a.to_m, b.from_m, b.to_m) >= distance_m;
}

std::optional<Clash> find_clash(const CollisionScene& scene, const Chain& chain, double clearance_m) {
  std::vector<Segment> axes;
  axes.reserve(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Capsule& body = scene.bodies[i];
    const Segment& here = axes.emplace_back(axis_in_block(body, chain));
    for (const Box& obstacle : scene.obstacles) {
      if (is_apart(here, obstacle, body.radius_m + clearance_m + body.margin_m)) continue;
      return Clash{body.name, obstacle.name, segment_box_distance_m(here, obstacle) - body.radius_m};
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Capsule& other = scene.bodies[j];
      const double radii_m = body.radius_m + other.radius_m;
      if (are_neighbours(body, other)) continue;
      if (is_apart(here, axes[j], radii_m + self_clearance_m(clearance_m))) continue;
      return Clash{body.name, other.name,
                   segment_distance_m(here.from_m, here.to_m, axes[j].from_m, axes[j].to_m) - radii_m};
    }
  }
  return std::nullopt;
}

}  // namespace calib
