#include "config/block_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/block_place_file.hpp"
#include "config/bore_face.hpp"
#include "config/certificate.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/schema_version.hpp"
#include "config/serial_number.hpp"
#include "config/shapes.hpp"
#include "config/utc_text.hpp"

namespace cell {
namespace {

constexpr std::size_t kFaceCountMax = 100;
/// With a less known centre the clearances around a sphere would not hold.
constexpr double kSphereCenterStdMaxMm = 1.0;
/// Twice what find_one_sided_face() wants of the touches themselves.
constexpr double kEstimatedCapMinDegrees = 30.0;

calib::Face face_from_json(const JsonObject& object) {
  calib::Face face;
  face.plane.outward = unit_vector(object.at("outward"));
  face.plane.offset_m = object.metres("offset");
  const JsonValue center = object.at("center_mm");
  face.center_m = center.numbers<3>() * calib::kMetresPerMillimetre;
  if (std::abs(signed_distance_m(face.plane, face.center_m)) > kFaceCenterErrorMaxMetres) {
    center.fail("does not lie on the plane outward . X = offset_mm; correct one of the three");
  }
  const JsonValue edge = object.at("edge_u");
  face.edge_u = unit_vector(edge);
  if (std::abs(face.edge_u.dot(face.plane.outward)) > kDirectionErrorMax) {
    edge.fail("is not perpendicular to outward; give an edge that lies in the face");
  }
  const JsonValue half_extent = object.at("half_extent_mm");
  face.half_extent_m = half_extent.numbers<2>() * calib::kMetresPerMillimetre;
  if ((face.half_extent_m.array() <= 0.0).any())
    half_extent.fail("is not over 0; give half the length of both edges");
  return face;
}

calib::FaceUncertainty uncertainty_from_json(const JsonObject& object) {
  calib::FaceUncertainty uncertainty;
  uncertainty.std_offset_m = object.find_metres("std_offset", kNotNegative).value_or(0.0);
  if (const auto tilt = object.find("std_tilt_rad")) uncertainty.std_tilt_rad = tilt->number(kNotNegative);
  uncertainty.estimated = is_estimated_place(object);
  return uncertainty;
}

calib::Face sphere_from_json(const JsonObject& object) {
  const JsonValue half_angle = object.at("cap_half_angle_deg");
  const double half_angle_deg = half_angle.number({.min = kPositive.min, .max = 180.0});
  if (is_estimated_place(object) && half_angle_deg < kEstimatedCapMinDegrees) {
    half_angle.fail(
        "is " + plain_number(half_angle_deg) +
        ": touched from one side only, a sphere whose centre is estimated cannot be told from the "
        "arm; give at least " +
        plain_number(kEstimatedCapMinDegrees) + R"(, or "place": "known" with std_center_mm)");
  }
  return calib::sphere_face(object.at("center_mm").numbers<3>() * calib::kMetresPerMillimetre,
                            object.metres("radius", kPositive), unit_vector(object.at("cap_axis")),
                            calib::radians_from_degrees(half_angle_deg));
}

calib::FaceUncertainty sphere_uncertainty_from_json(const JsonObject& object) {
  constexpr NumberRange kCenters{.min = 0.0, .max = kSphereCenterStdMaxMm};
  return {.std_offset_m = object.find_metres("std_radius", kNotNegative).value_or(0.0),
          .estimated = is_estimated_place(object),
          .std_center_m = object.find_metres("std_center", kCenters).value_or(0.0)};
}

/// The ball is a solid: nothing of the arm may touch it but the stylus.
void add_sphere(const JsonObject& object, int number, Block& block) {
  block.faces.push_back(sphere_from_json(object));
  block.face_uncertainties.push_back(sphere_uncertainty_from_json(object));
  const calib::Face& face = block.faces.back();
  block.solids.push_back({.name = "ball of plane " + std::to_string(number),
                          .min_m = face.cap->center_m,
                          .max_m = face.cap->center_m,
                          .round_m = surface_of(face).radius_m()});
}

enum class FaceShape { kPlane, kSphere, kBore };

/// "plane" where it is not given.
FaceShape shape_of(const JsonValue& item, bool is_first_schema) {
  for (const auto& [key, value] : item.members()) {
    if (key != "shape") continue;
    if (is_first_schema) value.fail(R"(unknown key "shape" in a block of version 1; raise "schema" to 2)");
    const std::string shape = value.text();
    if (shape == "plane") return FaceShape::kPlane;
    if (shape == "sphere") return FaceShape::kSphere;
    if (shape == "bore") return FaceShape::kBore;
    value.fail("is " + in_quotes(shape) + R"(; "plane", "sphere" and "bore" can be touched)");
  }
  return FaceShape::kPlane;
}

JsonObject face_object(const JsonValue& item, FaceShape shape) {
  switch (shape) {
    case FaceShape::kPlane:
      return item.object({"plane", "shape", "outward", "offset_mm", "std_offset_mm", "std_tilt_rad",
                          "center_mm", "edge_u", "half_extent_mm", "place"});
    case FaceShape::kSphere:
      return item.object({"plane", "shape", "center_mm", "std_center_mm", "radius_mm", "std_radius_mm",
                          "cap_axis", "cap_half_angle_deg", "place"});
    case FaceShape::kBore:
      return bore_object(item);
  }
  throw std::logic_error("face_object: no such shape");
}

void read_faces(const JsonValue& value, bool is_first_schema, Block& block) {
  for (const JsonValue& item : value.items(1, kFaceCountMax)) {
    const FaceShape shape = shape_of(item, is_first_schema);
    const JsonObject object = face_object(item, shape);
    const int plane = static_cast<int>(block.faces.size()) + 1;
    const JsonValue given = object.at("plane");
    if (given.number() != plane)
      given.fail("is not " + std::to_string(plane) + "; number the planes 1, 2, 3, ... in order");
    switch (shape) {
      case FaceShape::kSphere:
        add_sphere(object, plane, block);
        break;
      case FaceShape::kBore:
        add_bore(object, is_estimated_place(object), block);
        break;
      case FaceShape::kPlane:
        block.faces.push_back(face_from_json(object));
        block.face_uncertainties.push_back(uncertainty_from_json(object));
        break;
    }
  }
}

void cut_bores(const JsonValue& faces, Block& block) {
  const auto items = faces.items(1, kFaceCountMax);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const calib::Face face = block.faces[i];
    if (face.bore) cut_bore(bore_object(items[i]), face, block);
  }
}

/// Faces written down with an uncertainty lie as far apart as a length says, within this many standard
/// deviations.
constexpr double kLengthDeviationsMax = 3.0;

/// An estimated face may lie anywhere; two known ones must agree with the certificate. Offsets and length are
/// of one certificate: what the less exact of both statements leaves open is not added to the other.
void demand_agreement(const JsonValue& value, const calib::KnownLength& length, const Block& block) {
  double drawn_m = 0.0, of_offsets = 0.0;
  const Eigen::Vector3d outward = block.faces[static_cast<std::size_t>(length.faces[0])].plane.outward;
  for (const int index : length.faces) {
    const auto face = static_cast<std::size_t>(index);
    const calib::FaceUncertainty& known = block.face_uncertainties[face];
    if (known.estimated) return;
    const calib::Plane& plane = block.faces[face].plane;
    const double along_m = plane.offset_m * plane.outward.dot(outward);
    drawn_m = face == static_cast<std::size_t>(length.faces[0]) ? along_m : drawn_m - along_m;
    of_offsets += known.std_offset_m * known.std_offset_m;
  }
  const auto rounded_mm = [](double m) { return plain_number(std::round(m * 1e9) / 1e6); };
  const double off_m = std::abs(length.value_m - std::abs(drawn_m));
  const double std_m = std::max(length.std_m, std::sqrt(of_offsets));
  if (off_m <= kLengthDeviationsMax * std_m + kFaceCenterErrorMaxMetres) return;
  value.fail("is " + rounded_mm(off_m) + " mm from what the two faces' offsets give, " +
             rounded_mm(std::abs(drawn_m)) +
             " mm; correct the value, the offsets or their standard deviations");
}

calib::KnownLength length_from_json(const JsonValue& value, const Block& block) {
  const auto& faces = block.faces;
  const JsonObject object = value.object({"planes", "value_mm", "std_mm"});
  calib::KnownLength length;
  const JsonValue planes = object.at("planes");
  const auto pair = planes.items(2, 2);
  for (std::size_t i = 0; i < pair.size(); ++i) {
    length.faces[i] = pair[i].integer(1, static_cast<int>(faces.size())) - 1;
  }
  const auto& first = faces[static_cast<std::size_t>(length.faces[0])];
  const auto& second = faces[static_cast<std::size_t>(length.faces[1])];
  for (std::size_t i = 0; i < pair.size(); ++i) {
    const calib::Face& face = faces[static_cast<std::size_t>(length.faces[i])];
    if (!face.is_flat())
      pair[i].fail(std::string("is a ") + (face.bore ? "bore" : "sphere") +
                   "; a length lies between two flat faces");
  }
  if (length.faces[0] == length.faces[1]) planes.fail("names one plane twice; a length lies between two");
  if (first.plane.outward.cross(second.plane.outward).norm() > kDirectionErrorMax) {
    planes.fail("the two planes are not parallel; a length lies between parallel faces");
  }
  length.value_m = object.metres("value", kPositive);
  length.std_m = object.metres("std", kPositive);
  demand_agreement(object.at("value_mm"), length, block);
  return length;
}

/// Each pair of faces may agree with its length, and all of them together not.
void demand_one_certificate(const JsonValue& lengths, const Block& block) {
  const auto found = find_contradicted_length(block);
  if (!found) return;
  const JsonValue item = lengths.items(0, kFaceCountMax)[found->length];
  const JsonObject object = item.object({"planes", "value_mm", "std_mm"});
  object.at("value_mm")
      .fail("is " + plain_number(std::round(found->off_m * 1e9) / 1e6) +
            " mm from what all other lengths and offsets give together (chi-square " +
            plain_number(std::round(found->chi_square)) + " with " + std::to_string(found->degrees) +
            " degrees of freedom); correct it, the others or their standard deviations");
}

bool is_given(const std::vector<calib::KnownLength>& lengths, std::array<int, 2> faces) {
  return std::ranges::any_of(lengths, [&](const calib::KnownLength& length) {
    return length.faces == faces || length.faces == std::array{faces[1], faces[0]};
  });
}

/// The time of its measurement came with the second schema, and so did an expansion for the temperatures that
/// are told with each run.
void read_temperature(const JsonObject& object, bool is_first_schema, Block& block) {
  constexpr NumberRange kRoomTemperatures{kBlockTemperatureMinC, kBlockTemperatureMaxC};
  constexpr NumberRange kKelvins{0.0, kBlockTemperatureStdMaxK};
  constexpr NumberRange kExpansions{0.0, 1e-3};  // zinc's is 4e-5
  const auto at = object.find("temperature_at");
  if (at && is_first_schema)
    at->fail(R"(unknown key "temperature_at" in a block of version 1; raise "schema" to 2)");
  if (const auto temperature = object.find("temperature_c")) {
    block.temperature_c = temperature->number(kRoomTemperatures);
    block.std_temperature_k = object.at("std_temperature_k").number(kKelvins);
    block.thermal_expansion_per_k = object.at("thermal_expansion_per_k").number(kExpansions);
    if (at) block.temperature_at = time_from_utc(at->text());
    if (at && !block.temperature_at)
      at->fail("is " + in_quotes(at->text()) + R"(; give a time in UTC as "2026-01-31T08:15:30Z")");
    return;
  }
  const auto expansion = object.find("thermal_expansion_per_k");
  if (expansion && !is_first_schema) block.thermal_expansion_per_k = expansion->number(kExpansions);
  for (const auto& orphan :
       {object.find("std_temperature_k"), at, is_first_schema ? expansion : std::nullopt}) {
    if (orphan) orphan->fail("without \"temperature_c\"; add the block's temperature");
  }
}

constexpr std::array kBlockSchemas{kFirstBlockSchema, kSecondBlockSchema, kThirdBlockSchema, kBlockSchema};
constexpr std::size_t kPlaceCountMax = 8;

void read_places(const JsonValue& value, Block& block) {
  for (const JsonValue& item : value.items(1, kPlaceCountMax)) {
    const BlockPlace place = block_place_from_json(item);
    if (std::ranges::find(block.places, place.name, &BlockPlace::name) != block.places.end())
      item.fail("the name " + in_quotes(place.name) + " is there twice; name each place differently");
    block.places.push_back(place);
  }
}

}  // namespace

Block read_block(const std::filesystem::path& file) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const SchemaVersion version = schema_version(document, "block", kBlockSchemas);
  const bool is_first_schema = version.number == 1;
  const JsonObject object =
      JsonValue(source, document)
          .document(kBlockSchemas[static_cast<std::size_t>(version.number) - 1],
                    {"schema", "name", "serial", "temperature_c", "std_temperature_k", "temperature_at",
                     "thermal_expansion_per_k", "certificate", "faces", "lengths", "solids", "places"});
  Block block;
  block.file = file;
  block.name = object.at("name").text();
  block.serial = serial_number(find_since(3, object, "serial", version));
  read_temperature(object, is_first_schema, block);
  if (const auto certificate = object.find("certificate")) {
    for (const auto& [key, value] : certificate->members()) block.certificate.emplace(key, value.text());
  }
  read_faces(object.at("faces"), is_first_schema, block);
  if (const auto lengths = object.find("lengths")) {
    for (const JsonValue& item : lengths->items(0, kFaceCountMax)) {
      const calib::KnownLength length = length_from_json(item, block);
      if (is_given(block.lengths, length.faces)) {
        item.fail("is the second length of these two planes; one certificate counts once, keep one of them");
      }
      block.lengths.push_back(length);
    }
    demand_one_certificate(*lengths, block);
  }
  const std::vector<calib::Box> boxes = boxes_from_json(object.at("solids"));
  block.solids.insert(block.solids.begin(), boxes.begin(), boxes.end());  // before the balls
  cut_bores(object.at("faces"), block);
  if (const auto places = find_since(4, object, "places", version)) read_places(*places, block);
  return block;
}

}  // namespace cell
