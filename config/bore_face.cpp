#include "config/bore_face.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib_core/geometry/units.hpp"
#include "config/block_file.hpp"
#include "config/config_error.hpp"

namespace cell {
namespace {

/// With a less known axis the clearances in a bore would not hold.
constexpr double kBoreAxisStdMaxMm = 1.0;
constexpr double kBoreTiltStdMaxRadians = 0.02;
/// Twice what find_one_sided_face() wants of the touches themselves, to either side.
constexpr double kEstimatedWallMinDegrees = 30.0;
constexpr double kOnSolidMetres = 1e-6;

Eigen::Vector3d wall_middle_of(const JsonObject& object, const Eigen::Vector3d& axis) {
  const JsonValue given = object.at("wall_middle");
  const Eigen::Vector3d middle = unit_vector(given);
  if (std::abs(middle.dot(axis)) > kDirectionErrorMax)
    given.fail("is not perpendicular to axis; give the direction from the axis to the middle of the wall");
  return (middle - middle.dot(axis) * axis).normalized();
}

double half_angle_of(const JsonObject& object, bool is_estimated) {
  const JsonValue given = object.at("wall_half_angle_deg");
  const double half_angle_deg = given.number({.min = kPositive.min, .max = 180.0});
  if (is_estimated && half_angle_deg < kEstimatedWallMinDegrees) {
    given.fail(
        "is " + plain_number(half_angle_deg) +
        ": touched on one side only, a bore whose axis is estimated cannot be told from the arm; give at "
        "least " +
        plain_number(kEstimatedWallMinDegrees) + R"(, or "place": "known" with std_axis_mm)");
  }
  return calib::radians_from_degrees(half_angle_deg);
}

/// First and last depth below the mouth, metres.
Eigen::Vector2d depths_of(const JsonObject& object) {
  const JsonValue given = object.at("depth_mm");
  const Eigen::Vector2d depths_mm = given.numbers<2>();
  if (depths_mm[0] < 0.0 || depths_mm[1] <= depths_mm[0]) {
    given.fail(
        "is no range of depths; give the smallest and the largest depth below mouth_mm at which the "
        "ball may touch the wall, the smallest at least 0");
  }
  return depths_mm * calib::kMetresPerMillimetre;
}

calib::FaceUncertainty uncertainty_of(const JsonObject& object, bool is_estimated) {
  constexpr NumberRange kAxes{.min = 0.0, .max = kBoreAxisStdMaxMm};
  constexpr NumberRange kTilts{.min = 0.0, .max = kBoreTiltStdMaxRadians};
  calib::FaceUncertainty known{.std_offset_m = object.find_metres("std_radius", kAxes).value_or(0.0),
                               .estimated = is_estimated,
                               .std_center_m = object.find_metres("std_axis", kAxes).value_or(0.0)};
  if (const auto tilt = object.find("std_tilt_rad")) known.std_tilt_rad = tilt->number(kTilts);
  if (is_estimated && known.std_tilt_rad <= 0.0) {
    object.fail(
        "the axis of a bore at an unknown place has no known direction either, and the short way that a "
        "ball goes into it shows it poorly; give \"std_tilt_rad\" over 0, at most " +
        plain_number(kBoreTiltStdMaxRadians));
  }
  return known;
}

bool is_in(const calib::Box& solid, const Eigen::Vector3d& point_m) {
  return solid.contains(point_m, kOnSolidMetres);
}

void demand_in_solid(const JsonObject& object, const calib::Face& bore, const calib::Box& solid) {
  const calib::BoreWall& wall = *bore.bore;
  const Eigen::Vector3d mouth_m = wall.center_m + wall.mouth_m * wall.axis;
  constexpr double kLittleOutMetres = 1e-3;
  if (!is_in(solid, mouth_m) || is_in(solid, mouth_m + kLittleOutMetres * wall.axis)) {
    object.at("mouth_mm")
        .fail("is not on the side of the solid " + in_quotes(solid.name) +
              " that axis points out of; correct mouth_mm, axis or solid");
  }
  constexpr int kDirections = 36;
  const double radius_m = surface_of(bore).radius_m();
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector3d on_wall_m =
        wall.center_m - radius_m * (Eigen::AngleAxisd(2.0 * std::numbers::pi * i / kDirections, wall.axis) *
                                    bore.plane.outward);
    for (const double along_m : {bore.half_extent_m.x(), -bore.half_extent_m.x()}) {
      if (is_in(solid, on_wall_m + along_m * wall.axis)) continue;
      object.at(along_m < 0.0 ? "depth_mm" : "radius_mm")
          .fail("takes the wall of the bore out of the solid " + in_quotes(solid.name) +
                "; correct radius_mm, depth_mm or the solid");
    }
  }
}

/// A flat face has no material where the bore opens.
void demand_no_face_over(const JsonObject& object, const calib::Face& bore, const Block& block) {
  const calib::BoreWall& wall = *bore.bore;
  const double radius_m = surface_of(bore).radius_m();
  for (std::size_t i = 0; i < block.faces.size(); ++i) {
    const calib::Face& face = block.faces[i];
    const double rise = face.plane.outward.dot(wall.axis);
    if (!face.is_flat() || std::abs(rise) < kDirectionErrorMax) continue;
    const double along_m = -signed_distance_m(face.plane, wall.center_m) / rise;
    const Eigen::Vector3d opening_m = wall.center_m + along_m * wall.axis;
    const calib::Box& solid = *std::ranges::find(block.solids, object.at("solid").text(), &calib::Box::name);
    if (!is_in(solid, opening_m)) continue;
    const Eigen::Vector3d off_m = opening_m - face.center_m;
    const Eigen::Vector2d beyond_m =
        Eigen::Vector2d(off_m.dot(face.edge_u), off_m.dot(face.edge_v())).cwiseAbs() - face.half_extent_m;
    if (beyond_m.maxCoeff() > radius_m) continue;
    object.at("mouth_mm")
        .fail("the bore opens in what may be touched of plane " + std::to_string(i + 1) +
              "; give that face a center_mm and half_extent_mm beside the hole");
  }
}

}  // namespace

Eigen::Vector3d unit_vector(const JsonValue& value) {
  const Eigen::Vector3d direction = value.numbers<3>();
  if (std::abs(direction.norm() - 1.0) > kDirectionErrorMax) {
    value.fail("has length " + plain_number(direction.norm()) + "; give a unit vector");
  }
  return direction.normalized();
}

JsonObject bore_object(const JsonValue& item) {
  return item.object({"plane", "shape", "solid", "mouth_mm", "axis", "std_axis_mm", "std_tilt_rad",
                      "radius_mm", "std_radius_mm", "depth_mm", "wall_middle", "wall_half_angle_deg",
                      "place"});
}

void add_bore(const JsonObject& object, bool is_estimated, Block& block) {
  const Eigen::Vector3d axis = unit_vector(object.at("axis"));
  const Eigen::Vector3d mouth_m = object.at("mouth_mm").numbers<3>() * calib::kMetresPerMillimetre;
  const Eigen::Vector2d depths_m = depths_of(object);
  const double middle_m = 0.5 * depths_m.sum();
  block.faces.push_back(calib::bore_face({.center_m = mouth_m - middle_m * axis,
                                          .axis = axis,
                                          .mouth_m = middle_m,
                                          .half_angle_rad = half_angle_of(object, is_estimated)},
                                         object.metres("radius", kPositive), wall_middle_of(object, axis),
                                         0.5 * (depths_m[1] - depths_m[0])));
  block.face_uncertainties.push_back(uncertainty_of(object, is_estimated));
}

void cut_bore(const JsonObject& object, const calib::Face& bore, Block& block) {
  const JsonValue name = object.at("solid");
  const auto solid = std::ranges::find(block.solids, name.text(), &calib::Box::name);
  if (solid == block.solids.end() || solid->round_m > 0.0)
    name.fail("is no box among \"solids\"; name the one that the bore goes through");
  demand_in_solid(object, bore, *solid);
  demand_no_face_over(object, bore, block);
  solid->holes.push_back({bore.bore->center_m, bore.bore->axis, surface_of(bore).radius_m()});
}

}  // namespace cell
