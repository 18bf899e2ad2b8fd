#include "service/documents/internal/place_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/base/json_figures.hpp"

namespace cell {
namespace {

Json list(const Eigen::Vector3d& values, double scale) {
  return {scale * values.x(), scale * values.y(), scale * values.z()};
}

}  // namespace

Json block_pose_json(const std::optional<BlockPose>& place) {
  if (!place) return nullptr;
  constexpr double kMillimetres = 1e3, kDegrees = 1.0 / calib::kRadiansPerDegree;
  const Eigen::Matrix<double, 6, 1> std = place->covariance.diagonal().cwiseSqrt();
  const Eigen::AngleAxisd turn(place->cell_from_block.linear());
  return {{"located_at", place->located_at},
          {"shift_mm", list(place->cell_from_block.translation(), kMillimetres)},
          {"std_shift_mm", list(std.head<3>(), kMillimetres)},
          {"turn_deg", list(turn.angle() * turn.axis(), kDegrees)},
          {"std_turn_deg", list(std.tail<3>(), kDegrees)},
          {"touch_count", place->touches.size()}};
}

}  // namespace cell
