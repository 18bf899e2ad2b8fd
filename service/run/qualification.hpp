#pragma once

#include "calib_core/qualification/qualification.hpp"
#include "config/cell.hpp"
#include "service/run/verification.hpp"

namespace cell {

/// What the touches of a qualification are held against: the cell as warm as its block is, its limits, and
/// the calibration where there is one, which must outlive it.
calib::QualificationProblem qualification_problem(const Cell& cell, const Verification& against);

}  // namespace cell
