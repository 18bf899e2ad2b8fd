#pragma once

#include <optional>
#include <set>
#include <vector>

#include "calib_core/planning/online_estimate.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// Whether the block still stands where it was located: a run's first touch on each face is held against what
/// the touches that found the place say. A value without I/O; one a run. It has no say any more once every
/// face that found the place was met.
class PlaceCheck {
 public:
  /// `problem` is that of the run.
  PlaceCheck(calib::PlanningProblem problem, const BlockPose& place);

  /// A contact of the run; the fault to hold on when it is not where the face was located.
  std::optional<Fault> check(const calib::Touch& touch);
  /// A fault of a touch at a face: that the block was moved, when the face was not met at all where it was
  /// located; else the fault itself.
  [[nodiscard]] Fault explain(Fault fault, int face) const;

 private:
  std::optional<calib::OnlineArmEstimate> aim_;  // with the touches that found the place
  std::set<int> faces_;                          // that they are on
  std::set<int> faces_met_;                      // by the run
};

}  // namespace cell
