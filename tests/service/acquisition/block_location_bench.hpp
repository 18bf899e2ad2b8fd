#pragma once

#include <gtest/gtest.h>

#include <stdexcept>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "service/acquisition/block_location.hpp"
#include "service/acquisition/block_pass.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {

/// The ball at the spot, in the orientation of a planned touch of that face over which the arm can come
/// from its park posture and leave again.
inline calib::JointVector at(const PlaceSpot& spot) {
  const Cell& cell = cell_of_owners();
  static const calib::TransferSpace space(cell.arm.model, cell.collision_scene(), cell.park_joints,
                                          cell.nominal_position_error_m);
  const Eigen::Vector3d& outward = cell.block.faces[static_cast<std::size_t>(spot.face)].plane.outward;
  for (const calib::PlannedTouch& touch : plan_of_owners().touches.touches) {
    if (touch.face != spot.face) continue;
    Eigen::Isometry3d pose = calib::forward_kinematics(cell.arm.model, touch.joints);
    pose.translation() = spot.point_m + cell.probe.stylus.radius_m * outward;
    const auto joints = calib::solve_near(cell.arm.model, pose, touch.joints);
    if (!joints) continue;
    const auto over = pass_postures(cell, {{spot.face, *joints, kHandNoiseMetres}});
    const auto* postures = std::get_if<std::vector<calib::JointVector>>(&over);
    if (postures && calib::can_reach_park(space, postures->front())) return *joints;
  }
  throw std::runtime_error("nobody can touch there");
}

/// The cell of the owners with something beside the block where the arm would go around it.
inline Cell cramped_cell() {
  Cell cell = cell_of_owners();
  const PlaceSpot end = place_spots(cell).back();
  const calib::Face& face = cell.block.faces[static_cast<std::size_t>(end.face)];
  const Eigen::Vector3d middle_m = face.center_m + 0.2 * face.plane.outward;
  const Eigen::Vector3d half_m = Eigen::Vector3d::Constant(0.3) - 0.13 * face.plane.outward.cwiseAbs();
  cell.keep_out_boxes.push_back({"rack", middle_m - half_m, middle_m + half_m});
  return cell;
}

/// A dialogue that finds the block, with touches by hand of an arm without errors.
class BlockLocationTest : public ::testing::Test, public OwnersBench {
 protected:
  BlockLocationTest() { status.enter(State::kIdle); }

  /// One touch by hand, at this posture.
  void touch(const calib::JointVector& joints) { touch(location_, joints); }
  void touch(BlockLocation& location, const calib::JointVector& joints) {
    jog_against(location, joints);
    settle();
  }
  /// ... of which nobody has stored anything yet.
  static void jog_against(BlockLocation& location, const calib::JointVector& joints) {
    cs8::State state = ScriptedController::ready_state();
    state.joints = to_wire(joints);
    location.on_controller_state(state);
    state.flags = (state.flags | cs8::kProbeTouched) & ~static_cast<std::uint32_t>(cs8::kProbeLoopClosed);
    location.on_controller_state(state);
  }
  /// What was to be stored is, and who waits for it is told.
  void settle() {
    io.restart();
    io.poll();
  }
  /// The whole dialogue, with the block where the cell's file has it.
  void touch_all_spots() { touch_all_spots(location_); }
  void touch_all_spots(BlockLocation& location) {
    ASSERT_FALSE(location.locate());
    for (const PlaceSpot& spot : place_spots(cell_of_owners())) touch(location, at(spot));
  }

  BlockLocation location_{
      io.get_executor(), io.get_executor(), cell_of_owners(), queue, session, status, wake, time.clocks()};
};

}  // namespace cell
