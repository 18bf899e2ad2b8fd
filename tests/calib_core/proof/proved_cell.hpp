#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "calib_core/observability/observation_matrix.hpp"
#include "calib_core/proof/calibration_record.hpp"
#include "calib_core/proof/touch_rows.hpp"
#include "tests/calib_core/drawn_cell.hpp"

/// A drawn cell with its calibration, and touches of the same arm afterwards.
namespace calib::proved {

inline constexpr std::uint64_t kSeed = 5;
inline constexpr double kNoiseMetres = 10e-6;

class Cell {
 public:
  Cell() : chance_(kSeed) {
    problem_ = drawn::problem(drawn::uncertain_artefact(5), kNoiseMetres);
    truth_ = drawn::draw_truth(problem_, chance_);
    problem_.touches = drawn::touches(truth_, {.count = 100, .noise_m = kNoiseMetres}, chance_);
    options_.measure_noise = false;  // it is the declared one
    result_ = identify(problem_, options_);
    record_.emplace(problem_, options_, result_);
  }

  [[nodiscard]] const IdentificationProblem& problem() const { return problem_; }
  [[nodiscard]] const IdentificationOptions& options() const { return options_; }
  [[nodiscard]] const IdentificationResult& result() const { return result_; }
  [[nodiscard]] const CalibrationRecord& record() const { return *record_; }
  [[nodiscard]] const KinematicModel& true_arm() const { return truth_.arm; }
  /// Where the ball's centre really is at the trigger.
  [[nodiscard]] const ContactSurface& surface(int face) const {
    return truth_.planes[static_cast<std::size_t>(face)];
  }

  /// Touches of `arm` with the block moved, evenly over its faces.
  std::vector<Touch> touches_at(const Eigen::Isometry3d& calibrated_from_block, const KinematicModel& arm,
                                int count, double noise_m = kNoiseMetres) {
    drawn::Truth there = truth_;
    there.arm = arm_at(arm, calibrated_from_block);
    return drawn::touches(there, {.count = count, .noise_m = noise_m}, chance_);
  }

  /// The same touches once more, by `arm` as it is then.
  std::vector<Touch> again(std::vector<Touch> touches, const KinematicModel& arm, double noise_m) {
    for (Touch& touch : touches) {
      ContactSurface plane = truth_.planes[static_cast<std::size_t>(touch.face)];
      plane.offset_m += noise_m * study::normal(chance_);
      touch = moved_onto_plane(arm, plane, touch);
    }
    return touches;
  }

 private:
  UniformChance chance_;
  IdentificationProblem problem_;
  IdentificationOptions options_;
  drawn::Truth truth_;
  IdentificationResult result_;
  std::optional<CalibrationRecord> record_;
};

/// y of the block's frame points down.
inline Eigen::Isometry3d lifted() {
  constexpr double kLiftMetres = 0.2;
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, -kLiftMetres, 0.0));
}

/// The arm with an offset of a joint, 1 to 6.
inline KinematicModel slipped(const KinematicModel& arm, int joint, double offset_rad) {
  ErrorVector errors = ErrorVector::Zero();
  errors[theta_index(joint - 1)] = offset_rad;
  return apply(arm, errors);
}

}  // namespace calib::proved
