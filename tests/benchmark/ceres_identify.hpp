#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace bench {

/// As many parameters as Ceres is compiled for: its Jets have a fixed size.
inline constexpr int kIdentifiedCount = 25;

/// kUsual: as Ceres's documentation does it; a residual block a touch, the forward kinematics templated frame
/// by frame, default options.
/// kTuned: all that made it faster; one block for all touches, so that what they share is computed once, a
/// point carried back instead of frames, a nearly undamped start, and GCC told to inline all arithmetic of
/// derivatives (gnu::flatten), which takes off a third.
/// kAnalytic: kTuned with the derivatives of our observation matrix instead of automatic ones, from touches
/// whose sines and cosines are computed once.
enum class CeresForm { kUsual, kTuned, kAnalytic };

enum class Covariance { kNo, kYes };

struct CeresResult {
  bool converged = false;
  int iterations = 0;
  calib::ErrorVector errors = calib::ErrorVector::Zero();  // metres and radians; 0 where not identified
  Eigen::MatrixXd covariance{};  // 25 x 25, for residuals with a standard deviation of 1 m; empty with kNo
};

/// What calib::identify solves once it has chosen `columns`: signed distances of the tips (metres),
/// DENSE_QR, one thread, a start at nominal. The problem is built anew each time. Throws
/// std::logic_error unless there are 25 columns.
CeresResult ceres_identify(const calib::KinematicModel& nominal,
                           std::span<const calib::ContactSurface> contact_planes,
                           std::span<const calib::Touch> touches, const std::vector<int>& columns,
                           CeresForm form, Covariance covariance);

}  // namespace bench
