#include "calib_core/estimation/artefact.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

namespace calib {
namespace {

using Shift = ArtefactParameter::Shift;

FaceUncertainty uncertainty_of(const ArtefactKnowledge& knowledge, std::size_t face) {
  return knowledge.face_uncertainties.empty() ? FaceUncertainty{} : knowledge.face_uncertainties.at(face);
}

double growth(const ArtefactKnowledge& knowledge) {
  return 1.0 + knowledge.thermal_expansion_per_k * knowledge.warmer_than_20_c_k;
}

/// A parameter that affects one face only.
ArtefactParameter of_face(const ArtefactKnowledge& knowledge, std::size_t face, std::string what,
                          ArtefactKind kind, double nominal, const Shift& shift) {
  ArtefactParameter parameter;
  parameter.name = "plane" + std::to_string(face + 1) + "_" + std::move(what);
  parameter.kind = kind;
  parameter.nominal = nominal;
  parameter.shifts.assign(knowledge.faces.size(), {});
  parameter.shifts[face] = shift;
  return parameter;
}

/// Rotating the normal by an angle about an edge through the centre c of the face adds (edge x n) . (P - c).
Shift tilt_about(const Face& face, const Eigen::Vector3d& edge) {
  const Eigen::Vector3d turned = edge.cross(face.plane.outward);
  return {-turned.dot(face.center_m), turned, Eigen::Vector3d::Zero()};
}

/// Centre and radius of a sphere.
void add_sphere(const ArtefactKnowledge& knowledge, std::size_t index, std::vector<ArtefactParameter>& all) {
  const Face& face = knowledge.faces[index];
  const FaceUncertainty known = uncertainty_of(knowledge, index);
  const std::array<std::pair<const char*, Eigen::Vector3d>, 3> axes{
      std::pair{"center_x", Eigen::Vector3d::UnitX()}, std::pair{"center_y", Eigen::Vector3d::UnitY()},
      std::pair{"center_z", Eigen::Vector3d::UnitZ()}};
  for (const auto& [what, axis] : axes) {
    if (!known.estimated && known.std_center_m <= 0.0) break;
    all.push_back(of_face(knowledge, index, what, ArtefactKind::kSphereCenter, face.cap->center_m.dot(axis),
                          {0.0, Eigen::Vector3d::Zero(), axis}));
    if (!known.estimated) all.back().std = known.std_center_m;
  }
  if (known.std_offset_m <= 0.0) return;
  all.push_back(of_face(knowledge, index, "radius", ArtefactKind::kSphereRadius, surface_of(face).radius_m(),
                        {-1.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}));
  all.back().std = known.std_offset_m;
}

void add_face(const ArtefactKnowledge& knowledge, std::size_t index, std::vector<ArtefactParameter>& all) {
  const Face& face = knowledge.faces[index];
  const FaceUncertainty known = uncertainty_of(knowledge, index);
  if (face.cap) {
    add_sphere(knowledge, index, all);
    return;
  }
  const auto prior = [&](double std) { return known.estimated ? std::nullopt : std::optional(std); };
  if (known.estimated || known.std_offset_m > 0.0) {
    all.push_back(of_face(knowledge, index, "offset", ArtefactKind::kFaceOffset, face.plane.offset_m,
                          {-1.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}));
    all.back().std = prior(known.std_offset_m);
  }
  if (known.estimated || known.std_tilt_rad > 0.0) {
    for (const auto& [what, edge] : {std::pair("tilt_u", face.edge_u), std::pair("tilt_v", face.edge_v())}) {
      all.push_back(of_face(knowledge, index, what, ArtefactKind::kFaceTilt, 0.0, tilt_about(face, edge)));
      all.back().std = prior(known.std_tilt_rad);
    }
  }
}

Shift even(double constant) { return {constant, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }

/// The block grows about the origin of R_-1: a plane moves away from it; a sphere moves and swells.
Shift growth_per_k(const ArtefactKnowledge& knowledge, const Face& face) {
  const double expansion = knowledge.thermal_expansion_per_k;
  if (!face.cap) return even(-expansion * face.plane.offset_m);
  return {-expansion * surface_of(face).radius_m(), Eigen::Vector3d::Zero(), expansion * face.cap->center_m};
}

/// A parameter that shifts every face by `shift(face)`.
template <class ShiftOfFace>
void add_for_all_faces(const ArtefactKnowledge& knowledge, std::string name, ArtefactKind kind,
                       double nominal, double std, const ShiftOfFace& shift,
                       std::vector<ArtefactParameter>& all) {
  if (std <= 0.0) return;
  ArtefactParameter parameter{std::move(name), kind, nominal, std, {}};
  for (const Face& face : knowledge.faces) {
    parameter.shifts.push_back(shift(face));
  }
  all.push_back(std::move(parameter));
}

std::optional<int> offset_parameter(const std::vector<ArtefactParameter>& all, int face) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].kind == ArtefactKind::kFaceOffset &&
        all[i].shifts[static_cast<std::size_t>(face)].constant != 0.0) {
      return static_cast<int>(i);
    }
  }
  return std::nullopt;
}

/// The distance of faces with the same normal is |o_a - o_b|, with opposite normals o_a + o_b.
ArtefactEquation equation_of(const ArtefactKnowledge& knowledge, const KnownLength& length,
                             const std::vector<ArtefactParameter>& all) {
  const Plane& a = knowledge.faces[static_cast<std::size_t>(length.faces[0])].plane;
  const Plane& b = knowledge.faces[static_cast<std::size_t>(length.faces[1])].plane;
  const double sign_b = a.outward.dot(b.outward) > 0.0 ? -1.0 : 1.0;
  const double drawn = a.offset_m + sign_b * b.offset_m;
  const double sign = drawn < 0.0 ? -1.0 : 1.0;
  ArtefactEquation equation{{}, length.value_m - std::abs(drawn), length.std_m};
  if (const auto index = offset_parameter(all, length.faces[0])) {
    equation.weights.emplace_back(*index, sign);
  }
  if (const auto index = offset_parameter(all, length.faces[1])) {
    equation.weights.emplace_back(*index, sign * sign_b);
  }
  return equation;
}

}  // namespace

Artefact make_artefact(const ArtefactKnowledge& knowledge) {
  Artefact artefact;
  for (std::size_t face = 0; face < knowledge.faces.size(); ++face) {
    Face warm = knowledge.faces[face];
    warm.plane.offset_m *= growth(knowledge);
    if (warm.cap) warm.cap->center_m *= growth(knowledge);
    artefact.contact_planes.push_back(contact_plane(warm, knowledge.stylus));
    add_face(knowledge, face, artefact.parameters);
  }
  add_for_all_faces(
      knowledge, "stylus_radius", ArtefactKind::kStylusRadius, knowledge.stylus.radius_m,
      knowledge.std_radius_m, [](const Face&) { return even(-1.0); }, artefact.parameters);
  add_for_all_faces(
      knowledge, "pretravel", ArtefactKind::kPretravel, knowledge.stylus.pretravel_m,
      knowledge.std_pretravel_m, [](const Face&) { return even(1.0); }, artefact.parameters);
  add_for_all_faces(
      knowledge, "block_temperature", ArtefactKind::kTemperature, 20.0 + knowledge.warmer_than_20_c_k,
      knowledge.thermal_expansion_per_k == 0.0 ? 0.0 : knowledge.std_temperature_k,
      [&](const Face& face) { return growth_per_k(knowledge, face); }, artefact.parameters);
  for (const KnownLength& length : knowledge.lengths) {
    ArtefactEquation equation = equation_of(knowledge, length, artefact.parameters);
    if (!equation.weights.empty() && length.std_m > 0.0) artefact.equations.push_back(std::move(equation));
  }
  return artefact;
}

Artefact exact_artefact(std::vector<ContactSurface> contact_planes) {
  Artefact artefact;
  artefact.contact_planes = std::move(contact_planes);
  return artefact;
}

void correct_contact_planes(const Artefact& artefact, const Eigen::VectorXd& errors,
                            std::vector<ContactSurface>& planes) {
  planes.assign(artefact.contact_planes.begin(), artefact.contact_planes.end());
  for (Eigen::Index k = 0; k < errors.size(); ++k) {
    const auto& shifts = artefact.parameters[static_cast<std::size_t>(k)].shifts;
    for (std::size_t face = 0; face < planes.size(); ++face) {
      ContactSurface& surface = planes[face];
      surface.offset_m -= errors[k] * shifts[face].constant;
      if (!surface.center_m) {
        surface.outward += errors[k] * shifts[face].per_metre;
        continue;
      }
      const Eigen::Vector3d moved_m = errors[k] * shifts[face].center;
      *surface.center_m += moved_m;
      surface.offset_m += surface.outward.dot(moved_m);  // the radius stays
    }
  }
}

}  // namespace calib
