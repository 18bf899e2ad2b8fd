#include "service/setup/block_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "service/setup/internal/answer_json.hpp"

namespace cell {
namespace {

/// Between the block and what is touched of the plate, and from there to the plate's edges.
constexpr double kPlateGapMm = 15.0;
constexpr double kPlateRimMm = 10.0;
constexpr double kPlateEndMm = 30.0;

int axis_of(const TouchedSide& side) { return side.side[1] - 'x'; }

double sign_of(const TouchedSide& side) { return side.side[0] == '-' ? -1.0 : 1.0; }

SetupFace side_face(const CuboidAnswers& block, const TouchedSide& side) {
  const int axis = axis_of(side);
  const Eigen::Vector3d outward = sign_of(side) * Eigen::Vector3d::Unit(axis);
  const bool is_top = axis == 1;
  SetupFace face{.name = side.name, .outward = outward};
  face.offset_mm = is_top ? block.size_mm.y() : 0.5 * block.size_mm[axis];
  face.center_mm = face.offset_mm * outward;
  if (!is_top) face.center_mm.y() = -0.5 * block.size_mm.y();
  // As the shipped blocks have it: along z on the sides that face x, else along x.
  const int along = axis == 0 ? 2 : 0;
  const int across = 3 - axis - along;
  face.edge_u = Eigen::Vector3d::Unit(along);
  face.half_extent_mm = {0.5 * block.size_mm[along], 0.5 * block.size_mm[across]};
  return face;
}

SetupFace plate_face(const CuboidAnswers& block, const Eigen::Vector3d& base_position_mm) {
  const int axis = std::abs(base_position_mm.x()) >= std::abs(base_position_mm.z()) ? 0 : 2;
  const double away = base_position_mm[axis] > 0.0 ? -1.0 : 1.0;
  const double from = 0.5 * block.size_mm[axis] + kPlateGapMm;
  const double to = 0.5 * block.plate_mm[axis] - kPlateRimMm;
  const double half_along = 0.5 * (to - from);
  const double half_across = 0.5 * block.plate_mm[2 - axis] - kPlateEndMm;
  SetupFace face{.name = "ground plate", .outward = -Eigen::Vector3d::UnitY()};
  face.center_mm = away * 0.5 * (from + to) * Eigen::Vector3d::Unit(axis);
  face.edge_u = Eigen::Vector3d::UnitX();
  face.half_extent_mm =
      axis == 0 ? Eigen::Vector2d(half_along, half_across) : Eigen::Vector2d(half_across, half_along);
  return face;
}

/// Of a face that is flat within the deviation over its shorter edge, evenly spread; to two digits.
double tilt_std_rad(const CuboidAnswers& block, const SetupFace& face) {
  const double tilt = std::sqrt(3.0) * block.std_mm / (2.0 * face.half_extent_mm.minCoeff());
  const double last = std::pow(10.0, std::floor(std::log10(tilt)) - 1.0);
  return std::round(tilt / last) * last;
}

Json face_json(const CuboidAnswers& block, const SetupFace& face, std::size_t plane) {
  return {{"plane", plane},
          {"outward", triple_json(face.outward)},
          {"offset_mm", face.offset_mm},
          {"std_offset_mm", block.std_mm},
          {"std_tilt_rad", tilt_std_rad(block, face)},
          {"center_mm", triple_json(face.center_mm)},
          {"edge_u", triple_json(face.edge_u)},
          {"half_extent_mm", {face.half_extent_mm.x(), face.half_extent_mm.y()}},
          {"place", "known"}};
}

/// Between parallel faces that are both touched; with the plate the height counts.
Json lengths_json(const CuboidAnswers& block, const std::vector<SetupFace>& faces) {
  Json lengths = Json::array();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      const double along = faces[i].outward.dot(faces[j].outward);
      if (std::abs(along) < 0.5) continue;
      lengths.push_back({{"planes", {i + 1, j + 1}},
                         {"value_mm", std::abs(faces[i].offset_mm - along * faces[j].offset_mm)},
                         {"std_mm", block.std_mm}});
    }
  }
  return lengths;
}

Json solid_json(const calib::Box& box) {
  return {{"name", box.name},
          {"min_mm", triple_json(box.min_m / calib::kMetresPerMillimetre)},
          {"max_mm", triple_json(box.max_m / calib::kMetresPerMillimetre)}};
}

Json places_json(const CuboidAnswers& block) {
  Json places = Json::array();
  for (const PlaceAnswers& place : block.places)
    places.push_back({{"name", place.name},
                      {"position_mm", triple_json(place.position_mm)},
                      {"rotation_deg", triple_json(place.rotation_deg)},
                      {"place", "estimated"},
                      {"within_mm", place.within_mm}});
  return places;
}

/// A list with an entry a line, as the shipped files are written.
std::string lines_of(const Json& list) {
  std::string text = "[";
  for (const Json& entry : list) text += (text.size() > 1 ? ",\n    " : "\n    ") + entry.dump();
  return text + (list.empty() ? "]" : "\n  ]");
}

}  // namespace

std::vector<SetupFace> setup_faces(const CuboidAnswers& block, const Eigen::Vector3d& base_position_mm) {
  std::vector<SetupFace> faces;
  for (const TouchedSide& side : block.sides) faces.push_back(side_face(block, side));
  if (block.ground_plate) faces.push_back(plate_face(block, base_position_mm));
  return faces;
}

std::vector<calib::Box> setup_solids(const CuboidAnswers& block) {
  const Eigen::Vector3d half_mm = 0.5 * block.size_mm, half_plate_mm = 0.5 * block.plate_mm;
  const auto box = [](const char* name, const Eigen::Vector3d& min_mm, const Eigen::Vector3d& max_mm) {
    return calib::Box{name, calib::kMetresPerMillimetre * min_mm, calib::kMetresPerMillimetre * max_mm};
  };
  std::vector<calib::Box> solids{
      box("block", {-half_mm.x(), -block.size_mm.y(), -half_mm.z()}, {half_mm.x(), 0.0, half_mm.z()})};
  if (block.ground_plate)
    solids.push_back(box("plate", {-half_plate_mm.x(), 0.0, -half_plate_mm.z()},
                         {half_plate_mm.x(), block.plate_mm.y(), half_plate_mm.z()}));
  return solids;
}

std::string block_text(const CuboidAnswers& block, const Eigen::Vector3d& base_position_mm) {
  const std::vector<SetupFace> faces = setup_faces(block, base_position_mm);
  Json certificate = Json::object(), face_list = Json::array(), solids = Json::array();
  for (const auto& [key, text] : block.certificate) certificate[key] = text;
  std::string names;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    face_list.push_back(face_json(block, faces[i], i + 1));
    names += (i == 0 ? "" : ", ") + std::to_string(i + 1) + " " + faces[i].name;
  }
  // The reader of a report knows them by these names.
  certificate["planes"] = names;
  for (const calib::Box& solid : setup_solids(block)) solids.push_back(solid_json(solid));
  std::string text = "{\n  \"schema\": \"touchcal/block/4\",\n  \"name\": " + Json(block.name).dump();
  if (block.serial) text += ",\n  \"serial\": " + Json(*block.serial).dump();
  if (block.temperature_c)
    text += ",\n  \"temperature_c\": " + Json(*block.temperature_c).dump() +
            ",\n  \"std_temperature_k\": " + Json(block.std_temperature_k).dump();
  text += ",\n  \"thermal_expansion_per_k\": " + Json(block.expansion_per_k).dump();
  text += ",\n  \"certificate\": " + certificate.dump();
  text += ",\n  \"faces\": " + lines_of(face_list);
  text += ",\n  \"lengths\": " + lines_of(lengths_json(block, faces));
  if (!block.places.empty()) text += ",\n  \"places\": " + lines_of(places_json(block));
  return text + ",\n  \"solids\": " + lines_of(solids) + "\n}\n";
}

}  // namespace cell
