#pragma once

#include <string>
#include <vector>

#include "calib_core/estimation/block_registration.hpp"
#include "config/cell.hpp"

namespace cell {

/// Where the block was found by touching it. Kept in the state directory; the cell's file stays as it is.
struct LocatedPlace {
  Eigen::Isometry3d cell_from_block;  // R_-1 as it stands, in R_-1 as the cell's file has it
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // of shift above turn
  calib::ErrorTolerances std_block_pose{};        // one standard deviation of the six errors of the place
  std::vector<calib::RegistrationTouch> touches;  // that it was found with
  std::string located_at;                         // RFC 3339
  std::string digest;                             // place_digest() of the cell that it was found in
};

/// Of all that a place is relative to: the arm's frames, the faces and the ball. A place of another digest is
/// that of another cell.
std::string place_digest(const Cell& cell);

/// The cell with its block where it was found, and its place as uncertain as that: what runs plan with.
Cell cell_at(const Cell& cell, const LocatedPlace& place);

}  // namespace cell
