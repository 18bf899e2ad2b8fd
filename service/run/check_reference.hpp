#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/proof/check.hpp"

namespace cell {

/// A complete check without a verdict: one that is part of the reference of its calibration, or may become
/// so.
struct ReferenceCandidate {
  std::int64_t run = 0;
  calib::ReferenceTime time;
};

/// Which of a calibration's candidates are its reference: their indices, by the numbers of their runs.
/// calib::kReferenceCount of them are a whole reference: the first that agreed, which is the reference for
/// ever, whatever comes later. Fewer are the newest candidate and those that agree with it: where the newest
/// agrees with none, the reference begins anew there, and an older one is taken again once a newer agrees
/// with it. Two agree when they are the same touches; one with another number of touches than a check has is
/// never part of it.
///
/// `arm`: the cell's nominal one. By run numbers and not by time: a check that is imported behind newer ones
/// must not change what these were judged against.
std::vector<std::size_t> reference_among(const calib::KinematicModel& arm,
                                         std::span<const ReferenceCandidate> candidates);

}  // namespace cell
