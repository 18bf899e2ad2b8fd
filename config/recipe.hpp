#pragma once

#include <string>
#include <vector>

#include "calib_core/identify.hpp"

namespace cell {

/// Which touches a run makes and how they are identified.
struct Recipe {
  std::string name;
  std::string description;
  std::vector<int> faces;  // indices into the block's faces
  int fit_per_face = 0;
  int held_out_per_face = 0;
  calib::IdentificationOptions identification;
};

}  // namespace cell
