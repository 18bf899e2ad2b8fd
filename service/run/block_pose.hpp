#pragma once

#include <string>
#include <vector>

#include "calib_core/estimation/block_registration.hpp"
#include "config/cell.hpp"

namespace cell {

/// Pose of the block as located by touches. Kept in the state directory; the cell's file is not changed.
struct BlockPose {
  Eigen::Isometry3d cell_from_block;  // R_-1 as located, in R_-1 of the cell's file
  Eigen::Matrix<double, 6, 6> covariance =
      Eigen::Matrix<double, 6, 6>::Zero();        // translation first, then rotation
  calib::ErrorTolerances std_block_pose{};        // standard deviations of the six pose errors
  std::vector<calib::RegistrationTouch> touches;  // it was computed from
  std::string located_at;                         // RFC 3339
  std::string digest;                             // block_pose_digest() of the cell it was located in
};

/// Digest of all that a pose depends on: the arm's frames, the faces and the ball. A pose with another digest
/// belongs to another cell.
std::string block_pose_digest(const Cell& cell);

/// 3 sigma, in any direction, of that corner of the faces which the place says least of; metres.
/// `covariance`: as in BlockPose.
double place_error_m(const Eigen::Matrix<double, 6, 6>& covariance, const std::vector<calib::Face>& faces);

/// The cell with its block at this pose and with the uncertainty of this pose: what runs are planned with.
Cell cell_with_block_pose(const Cell& cell, const BlockPose& place);

}  // namespace cell
