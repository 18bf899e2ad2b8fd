#include "service/run/block_pose.hpp"

#include "config/json_value.hpp"
#include "service/base/digest.hpp"
#include "service/run/moved_cell.hpp"

namespace cell {

std::string block_pose_digest(const Cell& cell) {
  std::string text = cell.arm.name;
  const auto add = [&text](double number) { text += ' ' + plain_number(number); };
  for (const calib::LinkParameters& link : cell.arm.model.links)
    for (const double number : {link.alpha_rad, link.d_m, link.theta_rad, link.r_m, link.beta_rad})
      add(number);
  for (const calib::Face& face : cell.block.faces) {
    if (face.cap) continue;  // a block is located on its flats
    for (int axis = 0; axis < 3; ++axis) add(face.plane.outward[axis]);
    add(face.plane.offset_m);
  }
  add(cell.probe.stylus.radius_m);
  add(cell.probe.stylus.pretravel_m);
  return sha256_hex(text).substr(0, 32);
}

Cell cell_with_block_pose(const Cell& cell, const BlockPose& place) {
  Cell there = with_block_moved(cell, place.cell_from_block);
  for (std::size_t i = 0; i < place.std_block_pose.size(); ++i)
    if (place.std_block_pose[i]) there.arm.std_errors[i] = place.std_block_pose[i];
  return there;
}

}  // namespace cell
