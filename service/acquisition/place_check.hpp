#pragma once

#include <optional>
#include <set>
#include <vector>

#include "calib_core/planning/online_estimate.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// Checks that the block is still where it was located: compares a run's first touch on each face with the
/// touches that found the pose. One per run, without I/O. It ends when every such face has been touched.
class PlaceCheck {
 public:
  /// `problem` is that of the run, with the nominal position error of the arm alone. Where the touches that
  /// found the place tell no more of a contact than that error, it may be off by as much as the place is
  /// uncertain: 3 sigma of the corners, 20 to 25 mm for the shipped blocks.
  PlaceCheck(calib::PlanningProblem problem, const BlockPose& place);

  /// Checks a contact of the run; returns the fault to hold on when it is not on the located face.
  std::optional<Fault> check(const calib::Touch& touch);
  /// Explains a fault of a touch: that the block was moved, when the located face has not been touched yet;
  /// else the fault itself.
  [[nodiscard]] Fault explain(Fault fault, int face) const;

 private:
  std::optional<calib::OnlineArmEstimate> aim_;  // with the touches that found the place
  std::set<int> faces_;                          // that they are on
  std::set<int> faces_met_;                      // by the run
  double arm_error_m_ = 0.0;                     // nominal position error of the arm
  double face_error_m_ = 0.0;                    // the same, or that of the place where it is larger
};

}  // namespace cell
