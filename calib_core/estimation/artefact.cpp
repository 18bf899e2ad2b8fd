#include "calib_core/estimation/artefact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "calib_core/estimation/internal/spread_artefact.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/scaled_cholesky.hpp"

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

Shift even(double constant) { return {constant, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }

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

/// Place of the axis and its tilts about the middle of the wall's depths, then the radius.
void add_bore(const ArtefactKnowledge& knowledge, std::size_t index, std::vector<ArtefactParameter>& all) {
  const Face& face = knowledge.faces[index];
  const FaceUncertainty known = uncertainty_of(knowledge, index);
  const Eigen::Vector3d u = -face.plane.outward, v = face.bore->axis.cross(u);
  for (const auto& [what, way] : {std::pair("axis_u", u), std::pair("axis_v", v)}) {
    if (!known.estimated && known.std_center_m <= 0.0) break;
    all.push_back(of_face(knowledge, index, what, ArtefactKind::kBoreAxis, face.bore->center_m.dot(way),
                          {0.0, Eigen::Vector3d::Zero(), way}));
    if (!known.estimated) all.back().std = known.std_center_m;
  }
  for (const auto& [what, edge] : {std::pair("tilt_u", u), std::pair("tilt_v", v)}) {
    if (known.std_tilt_rad <= 0.0) break;
    all.push_back(of_face(knowledge, index, what, ArtefactKind::kBoreTilt, 0.0,
                          {0.0, Eigen::Vector3d::Zero(), -edge.cross(face.bore->center_m), edge}));
    all.back().std = known.std_tilt_rad;
  }
  if (known.std_offset_m <= 0.0) return;
  all.push_back(
      of_face(knowledge, index, "radius", ArtefactKind::kBoreRadius, surface_of(face).radius_m(), even(1.0)));
  all.back().std = known.std_offset_m;
}

void add_face(const ArtefactKnowledge& knowledge, std::size_t index, std::vector<ArtefactParameter>& all) {
  const Face& face = knowledge.faces[index];
  const FaceUncertainty known = uncertainty_of(knowledge, index);
  if (face.cap) {
    add_sphere(knowledge, index, all);
    return;
  }
  if (face.bore) {
    add_bore(knowledge, index, all);
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

/// The block grows about the origin of R_-1: a plane moves away from it; a sphere moves and swells, and so
/// does a bore, whose wall then is farther from the ball.
Shift growth_per_k(const ArtefactKnowledge& knowledge, const Face& face) {
  const double expansion = knowledge.thermal_expansion_per_k;
  if (face.is_flat()) return even(-expansion * face.plane.offset_m);
  if (face.bore)
    return {expansion * surface_of(face).radius_m(), Eigen::Vector3d::Zero(),
            expansion * face.bore->center_m};
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

/// Of the information that lengths have on a combination of offsets; that of the offsets' own priors is 1. A
/// length with less than this beyond it says nothing new.
constexpr double kNewInformationMin = 1e-6;
/// Weights below this fraction of the largest are rounding errors.
constexpr double kWeightRelative = 1e-9;

/// A length as an equation between offsets, with the certified deviation. The distance of faces with the same
/// normal is |o_a - o_b|, with opposite normals o_a + o_b.
ArtefactEquation certified_equation(const ArtefactKnowledge& knowledge, const KnownLength& length,
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

/// The equation of one direction q in the space of the parameters, each in its standard deviations.
ArtefactEquation equation_along(const Eigen::VectorXd& q, const Eigen::VectorXd& std, double value,
                                double precision) {
  const Eigen::VectorXd weights = q.cwiseQuotient(std);
  Eigen::Index most = 0;
  weights.cwiseAbs().maxCoeff(&most);
  ArtefactEquation equation{
      {}, value / weights[most], 1.0 / (std::abs(weights[most]) * std::sqrt(precision))};
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    const double weight = weights[k] / weights[most];
    if (std::abs(weight) > kWeightRelative) equation.weights.emplace_back(static_cast<int>(k), weight);
  }
  return equation;
}

/// Lengths and offsets are one certificate. In the offsets, each in its deviations, the priors are the unit
/// matrix and the lengths have the information G. Where an eigenvalue g of G exceeds 1 the lengths are the
/// more exact statement: they are to be the whole information on that combination of offsets, so that g - 1
/// is added. Elsewhere the offsets say it already.
std::vector<ArtefactEquation> new_equations(const ArtefactKnowledge& knowledge,
                                            const std::vector<ArtefactParameter>& all) {
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::VectorXd std(count);
  for (Eigen::Index k = 0; k < count; ++k)
    std[k] = all[static_cast<std::size_t>(k)].std.value_or(kFreeArtefactStd);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(count);
  for (const KnownLength& length : knowledge.lengths) {
    if (length.std_m <= 0.0) continue;
    const ArtefactEquation certified = certified_equation(knowledge, length, all);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(count);
    for (const auto& [index, weight] : certified.weights) row[index] = weight * std[index] / certified.std_m;
    information += row * row.transpose();
    moment += row * (certified.value_m / certified.std_m);
  }
  std::vector<ArtefactEquation> equations;
  if (information.isZero(0.0)) return equations;
  SymmetricEigen eigen;
  eigen.compute(information);
  for (Eigen::Index i = count - 1; i >= 0 && eigen.values()[i] > 1.0 + kNewInformationMin; --i) {
    const Eigen::VectorXd q = eigen.vectors().col(i);
    equations.push_back(equation_along(q, std, q.dot(moment) / eigen.values()[i], eigen.values()[i] - 1.0));
  }
  return equations;
}

}  // namespace

Artefact make_artefact(const ArtefactKnowledge& knowledge) {
  Artefact artefact;
  for (std::size_t face = 0; face < knowledge.faces.size(); ++face) {
    Face warm = knowledge.faces[face];
    warm.plane.offset_m *= growth(knowledge);
    if (warm.cap) warm.cap->center_m *= growth(knowledge);
    if (warm.bore) warm.bore->center_m *= growth(knowledge);
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
  artefact.equations = new_equations(knowledge, artefact.parameters);
  if (!knowledge.tips.empty()) spread_over_tips(knowledge, artefact);
  if (!knowledge.places.empty()) spread_over_places(knowledge, artefact);
  artefact.std_sideways_m = {knowledge.std_pretravel_tilt_m, knowledge.std_lobes_m, knowledge.std_lobes_m};
  return artefact;
}

std::vector<int> parameters_without_prior(const Artefact& artefact) {
  std::vector<int> indices;
  for (std::size_t k = 0; k < artefact.parameters.size(); ++k) {
    if (!artefact.parameters[k].std) indices.push_back(static_cast<int>(k));
  }
  return indices;
}

Eigen::MatrixXd prior_covariance(const Artefact& artefact) {
  const auto count = static_cast<Eigen::Index>(artefact.parameters.size());
  if (count == 0) return {};
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double std = artefact.parameters[static_cast<std::size_t>(k)].std.value_or(kFreeArtefactStd);
    information(k, k) = 1.0 / (std * std);
  }
  for (const ArtefactEquation& equation : artefact.equations) {
    for (const auto& [i, weight_i] : equation.weights) {
      for (const auto& [j, weight_j] : equation.weights)
        information(i, j) += weight_i * weight_j / (equation.std_m * equation.std_m);
    }
  }
  return ScaledCholesky(information).inverse();
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
    const ArtefactParameter& parameter = artefact.parameters[static_cast<std::size_t>(k)];
    if (is_of_place(parameter)) continue;
    const auto& shifts = parameter.shifts;
    for (std::size_t face = 0; face < planes.size(); ++face) {
      ContactSurface& surface = planes[face];
      surface.offset_m -= errors[k] * shifts[face].constant;
      surface.ball_m += errors[k] * shifts[face].ball;
      if (surface.is_flat()) {
        surface.outward += errors[k] * shifts[face].per_metre;
        surface.offset_m += errors[k] * shifts[face].center.dot(surface.outward);  // what it stands on grows
        continue;
      }
      const ContactSurface& nominal = artefact.contact_planes[face];
      const Eigen::Vector3d& turn = shifts[face].turn;
      const Eigen::Vector3d moved_m = errors[k] * (shifts[face].center + turn.cross(*nominal.center_m));
      *surface.center_m += moved_m;
      surface.offset_m += surface.outward.dot(moved_m);  // the radius stays
      if (surface.axis) *surface.axis += errors[k] * turn.cross(*nominal.axis);
    }
  }
  for (ContactSurface& surface : planes)
    if (surface.axis) surface.axis->normalize();
  if (errors.size() == 0) return;
  for (const PlaceParameters& place : artefact.places) correct_place(artefact, place, errors, planes);
}

}  // namespace calib
