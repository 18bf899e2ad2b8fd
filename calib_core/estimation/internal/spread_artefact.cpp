#include "calib_core/estimation/internal/spread_artefact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace calib {
namespace {

using Shift = ArtefactParameter::Shift;

ContactSurface moved(const Eigen::Isometry3d& pose, ContactSurface surface) {
  surface.outward = pose.linear() * surface.outward;
  surface.offset_m += surface.outward.dot(pose.translation());
  if (surface.center_m) surface.center_m = pose * *surface.center_m;
  if (surface.axis) surface.axis = pose.linear() * *surface.axis;
  return surface;
}

/// The same shift of a surface that stands at a pose, for points in the frame of that pose.
Shift moved(const Eigen::Isometry3d& pose, Shift shift) {
  shift.per_metre = pose.linear() * shift.per_metre;
  shift.constant -= shift.per_metre.dot(pose.translation());
  shift.turn = pose.linear() * shift.turn;
  shift.center = pose.linear() * shift.center - shift.turn.cross(pose.translation());
  return shift;
}

/// The pose of a place, if it is not exactly known.
void add_pose(const ArtefactPlace& place, std::size_t index, std::size_t face_count, Artefact& artefact) {
  if (place.std && place.std->std_position_m == 0.0 && place.std->std_turn_rad == 0.0) return;
  const Eigen::Vector3d origin_m = place.pose.translation();
  artefact.places.push_back(
      {static_cast<int>(index), static_cast<int>(artefact.parameters.size()), origin_m});
  for (const bool is_turn : {false, true}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
      Shift shift;
      shift.center = is_turn ? Eigen::Vector3d(-along.cross(origin_m)) : along;
      if (is_turn) shift.turn = along;
      ArtefactParameter parameter;
      parameter.name = "place_" + place.name + (is_turn ? "_turn_" : "_") + "xyz"[axis];
      parameter.kind = is_turn ? ArtefactKind::kPlaceTurn : ArtefactKind::kPlaceShift;
      parameter.nominal = is_turn ? 0.0 : origin_m[axis];
      if (place.std) parameter.std = is_turn ? place.std->std_turn_rad : place.std->std_position_m;
      parameter.shifts.assign(artefact.contact_planes.size(), {});
      const auto first = parameter.shifts.begin() + static_cast<std::ptrdiff_t>(index * face_count);
      std::fill(first, first + static_cast<std::ptrdiff_t>(face_count), shift);
      artefact.parameters.push_back(std::move(parameter));
    }
  }
}

/// The ball of a tip: its centre has no prior, its radius stands for that of the first one.
void add_ball(const ArtefactTip& tip, std::size_t index, std::size_t face_count, Artefact& artefact) {
  const auto add = [&](const std::string& what, ArtefactKind kind, double nominal, const Shift& shift) {
    ArtefactParameter parameter{"tip_" + tip.name + "_" + what, kind, nominal, {}, {}};
    parameter.shifts.assign(artefact.contact_planes.size(), {});
    const auto first = parameter.shifts.begin() + static_cast<std::ptrdiff_t>(index * face_count);
    std::fill(first, first + static_cast<std::ptrdiff_t>(face_count), shift);
    artefact.parameters.push_back(std::move(parameter));
  };
  if (tip.std_radius_m > 0.0) {
    add("radius", ArtefactKind::kStylusRadius, tip.radius_m, Shift{.constant = -1.0});
    artefact.parameters.back().std = tip.std_radius_m;
  }
  for (int axis = 0; axis < 3; ++axis) {
    Shift shift;
    shift.ball = Eigen::Vector3d::Unit(axis);
    add(std::string(1, "xyz"[axis]), ArtefactKind::kTipCenter, tip.center_m[axis], shift);
    artefact.parameters.back().within_m = tip.within_m;
  }
}

}  // namespace

void spread_over_tips(const ArtefactKnowledge& knowledge, Artefact& artefact) {
  const std::vector<ContactSurface> faces = artefact.contact_planes;
  artefact.face_count = faces.size();
  artefact.tip_count = 1 + knowledge.tips.size();
  for (const ArtefactTip& tip : knowledge.tips) {
    for (ContactSurface face : faces) {
      face.offset_m += tip.radius_m - knowledge.stylus.radius_m;
      face.ball_m = tip.center_m;
      artefact.contact_planes.push_back(face);
    }
  }
  for (ArtefactParameter& parameter : artefact.parameters) {
    const std::vector<Shift> shifts = parameter.shifts;
    const bool is_of_first = parameter.kind == ArtefactKind::kStylusRadius;
    for (std::size_t tip = 1; tip < artefact.tip_count; ++tip)
      for (const Shift& shift : shifts) parameter.shifts.push_back(is_of_first ? Shift{} : shift);
  }
  for (std::size_t tip = 1; tip < artefact.tip_count; ++tip)
    add_ball(knowledge.tips[tip - 1], tip, artefact.face_count, artefact);
}

void spread_over_places(const ArtefactKnowledge& knowledge, Artefact& artefact) {
  const std::vector<ContactSurface> faces = std::exchange(artefact.contact_planes, {});
  artefact.face_count = faces.size() / artefact.tip_count;
  for (const ArtefactPlace& place : knowledge.places) {
    for (const ContactSurface& face : faces) artefact.contact_planes.push_back(moved(place.pose, face));
  }
  for (ArtefactParameter& parameter : artefact.parameters) {
    const std::vector<Shift> shifts = std::exchange(parameter.shifts, {});
    for (const ArtefactPlace& place : knowledge.places) {
      for (std::size_t face = 0; face < shifts.size(); ++face) {
        Shift shift = moved(place.pose, shifts[face]);
        if (parameter.kind == ArtefactKind::kTemperature) shift.center += place.growth_m_per_k;
        parameter.shifts.push_back(shift);
      }
    }
  }
  for (std::size_t place = 0; place < knowledge.places.size(); ++place)
    add_pose(knowledge.places[place], place, faces.size(), artefact);
}

void correct_place(const Artefact& artefact, const PlaceParameters& place, const Eigen::VectorXd& errors,
                   std::vector<ContactSurface>& planes) {
  const Eigen::Vector3d shift_m = errors.segment<3>(place.first), turn = errors.segment<3>(place.first + 3);
  const double angle = turn.norm();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (angle > 0.0) motion.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  motion.translation() = place.origin_m + shift_m - motion.linear() * place.origin_m;
  for (std::size_t face = 0; face < planes.size(); ++face)
    if (artefact.place_of(face) == static_cast<std::size_t>(place.place))
      planes[face] = moved(motion, planes[face]);
}

}  // namespace calib
