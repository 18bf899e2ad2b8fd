#pragma once

#include <Eigen/Geometry>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/units.hpp"

namespace calib {

struct ReferencePose {
  bool table3 = false;
  JointVector joints;
  Eigen::Isometry3d block_from_tip = Eigen::Isometry3d::Identity();
};

/// From an independent program; see the comment on the file's first line.
inline std::vector<ReferencePose> read_reference_poses() {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/tests/data/reference_poses.csv");
  std::vector<ReferencePose> poses;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#') || line.starts_with("model")) continue;
    std::istringstream fields(line);
    std::string model;
    std::getline(fields, model, ',');
    std::vector<double> v;
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    if (v.size() != 18)
      throw std::runtime_error("reference pose with " + std::to_string(v.size()) + " numbers");
    ReferencePose pose{.table3 = model == "table3"};
    for (int i = 0; i < 6; ++i) pose.joints[i] = radians_from_degrees(v[static_cast<std::size_t>(i)]);
    for (int i = 0; i < 3; ++i)
      pose.block_from_tip.translation()[i] = metres_from_mm(v[static_cast<std::size_t>(6 + i)]);
    for (int i = 0; i < 9; ++i)
      pose.block_from_tip.linear()(i / 3, i % 3) = v[static_cast<std::size_t>(9 + i)];
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace calib
