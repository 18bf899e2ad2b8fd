#include "sim_controller/yielding_bodies.hpp"

#include <algorithm>
#include <cstddef>

namespace sim {
namespace {

/// The bodies of the probe, as indices into those of the scene.
std::vector<int> probe_bodies(const calib::CollisionScene& scene) {
  std::vector<int> found;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].frame == calib::kFrameCount - 1) found.push_back(static_cast<int>(i));
  return found;
}

double begins_at_m(const calib::Capsule& body) { return std::min(body.from_m.z(), body.to_m.z()); }
double reaches_to_m(const calib::Capsule& body) { return std::max(body.from_m.z(), body.to_m.z()); }

double distance_m(const calib::Capsule& body, const Eigen::Vector3d& point_m) {
  return calib::segment_distance_m(body.from_m, body.to_m, point_m, point_m) - body.radius_m;
}

}  // namespace

std::vector<int> yielding_bodies(const Plant& plant) {
  std::vector<int> of_probe = probe_bodies(plant.scene);
  if (of_probe.empty()) return {};
  const auto body = [&plant](int index) -> const calib::Capsule& {
    return plant.scene.bodies[static_cast<std::size_t>(index)];
  };
  const int stylus =
      *std::ranges::max_element(of_probe, {}, [&](int index) { return reaches_to_m(body(index)); });
  if (plant.tips.empty()) return {stylus};
  double seat_m = begins_at_m(body(stylus));  // nothing that hangs on it begins behind it
  for (const TipBall& tip : plant.tips) {
    const int stem = *std::ranges::min_element(
        of_probe, {}, [&](int index) { return distance_m(body(index), tip.center_m); });
    seat_m = std::min(seat_m, begins_at_m(body(stem)));
  }
  std::erase_if(of_probe, [&](int index) { return begins_at_m(body(index)) < seat_m; });
  return of_probe;
}

}  // namespace sim
