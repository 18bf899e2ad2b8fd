#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib_core/geometry/box.hpp"
#include "service/setup/answers.hpp"

namespace cell {

/// A face that will be touched, in R_-1, millimetres.
struct SetupFace {
  std::string name;  // as operators call it
  Eigen::Vector3d outward;
  double offset_mm = 0.0;
  Eigen::Vector3d center_mm;
  Eigen::Vector3d edge_u;
  Eigen::Vector2d half_extent_mm;
};

/// The faces in the order of their planes: the sides that are touched, then the plate's, beside the block on
/// the side that is farther from the arm. `base_position_mm`: where the arm is.
std::vector<SetupFace> setup_faces(const CuboidAnswers& block, const Eigen::Vector3d& base_position_mm);

/// The block, and the plate that it stands on.
std::vector<calib::Box> setup_solids(const CuboidAnswers& block);

/// The block's file.
std::string block_text(const CuboidAnswers& block, const Eigen::Vector3d& base_position_mm);

}  // namespace cell
