#include "service/run/block_pose.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "config/json_value.hpp"
#include "config/moved_cell.hpp"
#include "service/base/digest.hpp"

namespace cell {

std::string block_pose_digest(const Cell& cell) {
  std::string text = cell.arm.name;
  const auto add = [&text](double number) { text += ' ' + plain_number(number); };
  for (const calib::LinkParameters& link : cell.arm.model.links)
    for (const double number : {link.alpha_rad, link.d_m, link.theta_rad, link.r_m, link.beta_rad})
      add(number);
  for (const calib::Face& face : cell.block.faces) {
    if (!face.is_flat()) continue;  // a block is located on its flats
    for (int axis = 0; axis < 3; ++axis) add(face.plane.outward[axis]);
    add(face.plane.offset_m);
  }
  add(cell.probe.stylus.radius_m);
  add(cell.probe.stylus.pretravel_m);
  const calib::SidewaysPretravel& sideways = cell.probe.stylus.sideways;
  if (!sideways.is_zero()) {  // places that were found with a probe without these keep their digest
    for (const double number : {sideways.tilt_m, sideways.lobes_m, sideways.lobe_direction_rad}) add(number);
  }
  return sha256_hex(text).substr(0, 32);
}

double place_error_m(const Eigen::Matrix<double, 6, 6>& covariance, const std::vector<calib::Face>& faces) {
  constexpr double kSigmas = 3.0;
  double most_m2 = 0.0;
  for (const calib::Face& face : faces) {
    for (const double u : {-1.0, 1.0}) {
      for (const double v : {-1.0, 1.0}) {
        const Eigen::Vector3d corner_m = face.center_m + u * face.half_extent_m.x() * face.edge_u +
                                         v * face.half_extent_m.y() * face.edge_v();
        Eigen::Matrix<double, 3, 6> moves = Eigen::Matrix<double, 3, 6>::Zero();
        moves.leftCols<3>().setIdentity();
        for (int axis = 0; axis < 3; ++axis)
          moves.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(corner_m);
        const Eigen::Matrix3d of_corner = moves * covariance * moves.transpose();
        most_m2 =
            std::max(most_m2, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(of_corner).eigenvalues()[2]);
      }
    }
  }
  return kSigmas * std::sqrt(most_m2);
}

Cell cell_with_block_pose(const Cell& cell, const BlockPose& place) {
  Cell there = with_block_moved(cell, place.cell_from_block);
  there.place_error_m = place_error_m(place.covariance, cell.block.faces);
  for (std::size_t i = 0; i < place.std_block_pose.size(); ++i)
    if (place.std_block_pose[i]) there.arm.std_errors[i] = place.std_block_pose[i];
  return there;
}

}  // namespace cell
