#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "calib_core/estimation/artefact.hpp"

namespace cell {

/// What the place is called at which the block is located.
inline constexpr const char* kFirstPlace = "first";

/// Another place at which the block can stand, such as a dowelled stand: all that is on its first solid moves
/// there with it.
struct BlockPlace {
  std::string name;
  Eigen::Isometry3d first_from_place = Eigen::Isometry3d::Identity();  // R_-1 there, in R_-1 of the first one
  std::optional<calib::PlaceDeviation> std;  // certified; nothing: the touches find it
  double within_m = 0.0;                     // of a place that is found: how far it may be from that pose
  std::optional<double> thermal_expansion_per_k;  // of what it stands on; nothing: that of the block
};

}  // namespace cell
