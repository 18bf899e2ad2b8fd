#include "service/acquisition/locating.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/moved_cell.hpp"
#include "service/run/block_pose.hpp"

namespace cell {
namespace {

/// The spots lie so far out, in half extents of the face.
constexpr double kOut = 0.6;
/// As in calib_core/planning/online_estimate.hpp: an error of the arm is a sixth of the nominal miss, per
/// metre where it is an angle.
constexpr double kErrorShare = 1.0 / 6.0;
/// A ball that comes to rest this near to where it touched before is in the same contact: the probe bounced.
constexpr double kSameContactMetres = 0.002;

const calib::Face& face_of(const Cell& cell, int face) {
  return cell.block.faces[static_cast<std::size_t>(face)];
}

/// Whether a face can be located on: a flat that lies where the file has it.
bool is_known(const Cell& cell, int face) {
  const auto index = static_cast<std::size_t>(face);
  if (!face_of(cell, face).is_flat()) return false;
  return index >= cell.block.face_uncertainties.size() || !cell.block.face_uncertainties[index].estimated;
}

/// Top, side and end: the highest of the faces that look up most, then the two that stand squarest.
std::array<int, 3> chosen_faces(const Cell& cell) {
  constexpr double kAsGood = 1e-6;
  const Eigen::Vector3d up = up_in_block(cell);
  const int count = static_cast<int>(cell.block.faces.size());
  int top = -1;
  for (int face = 0; face < count; ++face) {
    if (!is_known(cell, face)) continue;
    if (top < 0) {
      top = face;
      continue;
    }
    const calib::Face &is = face_of(cell, face), &best = face_of(cell, top);
    const double gain = (is.plane.outward - best.plane.outward).dot(up);
    const double higher = (is.center_m - best.center_m).dot(up);
    if (gain > kAsGood || (gain > -kAsGood && higher > 0.0)) top = face;
  }
  double most = 0.2;  // of a square corner's volume, 1
  std::array<int, 3> chosen{-1, -1, -1};
  for (int side = 0; side < count; ++side) {
    for (int end = side + 1; end < count && top >= 0; ++end) {
      if (side == top || end == top || !is_known(cell, side) || !is_known(cell, end)) continue;
      const double volume = std::abs(face_of(cell, top).plane.outward.dot(
          face_of(cell, side).plane.outward.cross(face_of(cell, end).plane.outward)));
      if (volume <= most + kAsGood) continue;
      most = volume;
      chosen = {top, side, end};
    }
  }
  if (chosen[0] < 0)
    throw std::invalid_argument("the block has no three known flat faces that stand in a corner");
  return chosen;
}

/// The face that a direction in a face leads to.
int towards(const Cell& cell, int from, const Eigen::Vector3d& direction) {
  int found = from;
  double most = 0.5;
  for (int face = 0; face < static_cast<int>(cell.block.faces.size()); ++face) {
    const double along = face_of(cell, face).plane.outward.dot(direction);
    if (!face_of(cell, face).is_flat()) continue;
    if (face == from || along <= most) continue;
    most = along;
    found = face;
  }
  return found;
}

PlaceSpot spot_at(const Cell& cell, int index, double u, double v) {
  const calib::Face& face = face_of(cell, index);
  PlaceSpot spot{.face = index,
                 .point_m = face.center_m + u * face.half_extent_m.x() * face.edge_u +
                            v * face.half_extent_m.y() * face.edge_v(),
                 .words = fmt::format("plane {}", index + 1)};
  std::string near;
  const std::array<std::pair<double, Eigen::Vector3d>, 2> sides{std::pair{u, face.edge_u},
                                                                std::pair{v, face.edge_v()}};
  for (const auto& [share, edge] : sides) {
    if (share == 0.0) continue;
    const Eigen::Vector3d direction = (share > 0.0 ? 1.0 : -1.0) * edge;
    const int neighbour = towards(cell, index, direction);
    if (neighbour != index) {
      near += fmt::format("{}plane {}", near.empty() ? "" : " and ", neighbour + 1);
    } else {  // no face there has a number: named by the axis of R_-1
      Eigen::Index axis = 0;
      direction.cwiseAbs().maxCoeff(&axis);
      near += fmt::format("{}its {}{} edge", near.empty() ? "" : " and ", direction[axis] > 0.0 ? '+' : '-',
                          "xyz"[axis]);
    }
  }
  spot.words += near.empty() ? ", in its middle" : ", towards " + near;
  return spot;
}

}  // namespace

std::vector<PlaceSpot> place_spots(const Cell& cell) {
  const auto [top, side, end] = chosen_faces(cell);
  // The two touches on the side lie beside each other and give the block's rotation.
  const calib::Face& second = face_of(cell, side);
  const bool u_is_level =
      std::abs(second.edge_u.dot(up_in_block(cell))) < std::abs(second.edge_v().dot(up_in_block(cell)));
  const double u = u_is_level ? kOut : 0.0, v = u_is_level ? 0.0 : kOut;
  return {spot_at(cell, top, -kOut, -kOut), spot_at(cell, top, kOut, -kOut), spot_at(cell, top, 0.0, kOut),
          spot_at(cell, side, -u, -v),      spot_at(cell, side, u, v),       spot_at(cell, end, 0.0, 0.0)};
}

calib::ErrorTolerances believable_errors(const Cell& cell) {
  calib::ErrorTolerances errors = prior_tolerances(cell);
  for (auto& error : errors)
    error = std::max(kErrorShare * cell.nominal_position_error_m, error.value_or(0.0));
  return errors;
}

Locating::Locating(const Cell& cell)
    : problem_of_place_{.nominal = cell.arm.model,
                        .faces = cell.block.faces,
                        .stylus = cell.probe.stylus,
                        .touches = {},
                        .tilt_max_rad = cell.stylus_tilt_max_rad,
                        .arm_errors = believable_errors(cell)},
      touch_noise_m_(std::hypot(cell.touch_noise_m, kHandNoiseMetres)),
      overtravel_m_(cell.probe.overtravel_m),
      is_star_(!cell.probe.tips.empty()),
      spots_(place_spots(cell)) {}

HandGuide Locating::guide() const {
  const int total = static_cast<int>(spots_.size());
  const int made = static_cast<int>(touches_.size());
  HandGuide guide{.activity = HandActivity::kLocate,
                  .index = std::min(made + 1, total),
                  .total = total,
                  .problem = problem_};
  const PlaceSpot& spot = spots_[static_cast<std::size_t>(guide.index - 1)];
  guide.plane = spot.face + 1;
  if (fit_) {
    guide.step = HandStep::kPass;
    guide.words = fmt::format(
        "the place is found to {:.0f} mm (3 sigma at the corners of its faces): jog the arm clear of the "
        "block, then touchcal locate once more to go once around it 30 mm off its faces, at 10 % speed and "
        "without a touch; after that the place counts",
        calib::mm_from_metres(place_error_m(fit_->covariance, problem_of_place_.faces)));
  } else if (made == total) {
    guide.step = HandStep::kUndo;
    guide.words =
        "the place is not found: touchcal undo takes the last touch back, so that it can be made again; "
        "touchcal stop ends this";
  } else {
    guide.words = fmt::format(
        "touch {}: in manual mode jog {} against it, slowly at the end, until the probe trips, then back",
        spot.words, is_star_ ? "the ball of the first tip and no other" : "the ball");
  }
  return guide;
}

std::optional<std::string> Locating::why_not(const HandTouch& touch) const {
  if (touches_.size() == spots_.size()) return "all touches are made";
  const int face = spots_[touches_.size()].face;
  if (touch.moved_m && *touch.moved_m > kHandMovedMaxMetres) {
    return fmt::format("the ball moved {:.1f} mm during the touch: approach more slowly, under 25 mm/s",
                       calib::mm_from_metres(*touch.moved_m));
  }
  const auto ball_m = [&](const calib::JointVector& joints) -> Eigen::Vector3d {
    return calib::forward_kinematics(problem_of_place_.nominal, joints).translation();
  };
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    // On another face a touch near an edge may well be near; the same contact once more is not.
    const double apart_min_m =
        touches_[i].face == face ? calib::kRegistrationSpreadMinMetres : kSameContactMetres;
    if ((ball_m(touches_[i].joints) - ball_m(touch.joints)).norm() < apart_min_m)
      return fmt::format("that is where touch {} was: touch {}", i + 1, spots_[touches_.size()].words);
  }
  return std::nullopt;
}

void Locating::take(const HandTouch& touch) {
  problem_.reset();
  if (touches_.size() == spots_.size()) return;
  if (auto why = why_not(touch)) {
    refuse(*std::move(why));
    return;
  }
  // Evenly anywhere on the way since the state before, or behind the trigger.
  const double behind_m =
      touch.moved_m ? *touch.moved_m / std::sqrt(3.0) : kTakenOvertravelShare * overtravel_m_;
  const int face = spots_[touches_.size()].face;
  touches_.push_back({face, touch.joints, std::hypot(touch_noise_m_, behind_m)});
  find_place();
}

void Locating::undo() {
  problem_.reset();
  fit_.reset();
  if (!touches_.empty()) touches_.pop_back();
}

void Locating::find_place() {
  if (touches_.size() < spots_.size()) return;
  calib::BlockRegistrationProblem problem = problem_of_place_;
  problem.touches = touches_;
  auto outcome = calib::register_block(problem);
  if (auto* refusal = std::get_if<calib::BlockRegistrationRefusal>(&outcome)) {
    problem_ = std::move(refusal->message);
  } else {
    fit_ = std::get<calib::BlockRegistration>(std::move(outcome));
  }
}

}  // namespace cell
