#include "config/moved_cell.hpp"

#include <cmath>
#include <vector>

#include "calib_core/estimation/block_registration.hpp"

namespace cell {
namespace {

/// Axis-aligned bounding box in the new frame.
calib::Box moved_box(const Eigen::Isometry3d& new_from_old, const calib::Box& box) {
  const Eigen::Vector3d middle_m = new_from_old * (0.5 * (box.min_m + box.max_m));
  const Eigen::Vector3d half_m = new_from_old.linear().cwiseAbs() * (0.5 * (box.max_m - box.min_m));
  calib::Box there{box.name, middle_m - half_m, middle_m + half_m};
  there.round_m = box.round_m;
  return there;
}

/// A rotated box is cut into pieces of about this size; their bounding boxes forbid less space than one
/// bounding box of the whole.
constexpr double kPieceMetres = 0.2;

std::vector<calib::Box> moved_in_pieces(const Eigen::Isometry3d& new_from_old, const calib::Box& box) {
  constexpr double kAlongAxes = 1e-9;
  const Eigen::Matrix3d turn = new_from_old.linear().cwiseAbs();
  const bool is_ball = box.round_m > 0.0;
  if (is_ball || (turn.rowwise().maxCoeff().array() > 1.0 - kAlongAxes).all())
    return {moved_box(new_from_old, box)};
  const Eigen::Vector3d extent_m = box.max_m - box.min_m;
  const int count_x = static_cast<int>(std::ceil(extent_m.x() / kPieceMetres));
  const int count_z = static_cast<int>(std::ceil(extent_m.z() / kPieceMetres));
  const Eigen::Vector3d piece_m(extent_m.x() / count_x, extent_m.y(), extent_m.z() / count_z);
  std::vector<calib::Box> pieces;
  for (int x = 0; x < count_x; ++x) {
    for (int z = 0; z < count_z; ++z) {
      const Eigen::Vector3d min_m = box.min_m + Eigen::Vector3d(x * piece_m.x(), 0.0, z * piece_m.z());
      pieces.push_back(moved_box(new_from_old, {box.name, min_m, min_m + piece_m}));
    }
  }
  return pieces;
}

}  // namespace

std::vector<calib::Box> boxes_after_move(const std::vector<calib::Box>& boxes,
                                         const Eigen::Isometry3d& old_from_new) {
  const Eigen::Isometry3d new_from_old = old_from_new.inverse();
  std::vector<calib::Box> moved;
  for (const calib::Box& box : boxes) {
    const auto pieces = moved_in_pieces(new_from_old, box);
    moved.insert(moved.end(), pieces.begin(), pieces.end());
  }
  return moved;
}

Cell with_block_moved(const Cell& cell, const Eigen::Isometry3d& old_from_new) {
  Cell there = cell;
  const Eigen::Isometry3d new_from_old = old_from_new.inverse();
  calib::set_block_pose(there.arm.model, new_from_old * calib::block_pose_of(cell.arm.model));
  there.keep_out_boxes = boxes_after_move(cell.keep_out_boxes, old_from_new);
  there.workspace_box = moved_box(new_from_old, cell.workspace_box);
  return there;
}

Cell with_block_displaced(const Cell& cell, const BlockDisplacement& place) {
  return with_block_moved(
      cell, Eigen::Translation3d(place.shift_m) * Eigen::AngleAxisd(place.yaw_rad, Eigen::Vector3d::UnitY()));
}

Eigen::Vector3d up_in_block(const Cell& cell) {
  const Eigen::Matrix3d turn = calib::block_pose_of(cell.arm.model).linear();
  return -(turn * cell.arm.model.down_in_frame_1);
}

}  // namespace cell
