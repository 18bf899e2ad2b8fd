#include "service/documents/internal/place_view.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/documents/internal/document_fields.hpp"

namespace cell {
namespace {

std::array<double, 3> list(const Eigen::Vector3d& values, double scale) {
  return {scale * values.x(), scale * values.y(), scale * values.z()};
}

}  // namespace

std::optional<PlaceDocument> block_pose_of(const std::optional<BlockPose>& place) {
  if (!place) return std::nullopt;
  constexpr double kMillimetres = 1e3, kDegrees = 1.0 / calib::kRadiansPerDegree;
  const Eigen::Matrix<double, 6, 1> std = place->covariance.diagonal().cwiseSqrt();
  const Eigen::AngleAxisd turn(place->cell_from_block.linear());
  return PlaceDocument{.located_at = place->located_at,
                       .shift_mm = list(place->cell_from_block.translation(), kMillimetres),
                       .std_shift_mm = list(std.head<3>(), kMillimetres),
                       .turn_deg = list(turn.angle() * turn.axis(), kDegrees),
                       .std_turn_deg = list(std.tail<3>(), kDegrees),
                       .touch_count = place->touches.size()};
}

Json block_pose_json(const std::optional<BlockPose>& place) {
  Json json;
  FieldWriter::write(json, block_pose_of(place));
  return json;
}

}  // namespace cell
