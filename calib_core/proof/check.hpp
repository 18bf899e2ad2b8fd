#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/proof/calibration_record.hpp"

/// Whether a cell is still as it was: the same few touches at the place of the calibration, time and again,
/// against the mean of the first three times that agree. What all of them share with the calibration drops
/// out, so that a check sees ten times less than a calibration is wrong by.
namespace calib {

inline constexpr int kCheckTouchCount = 12;
inline constexpr int kReferenceCount = 3;

/// The joints whose offset a check sees, 1 to 6. An offset of joint 1 is one of the block's place, and that
/// of joint 6 turns the ball about its centre.
inline constexpr std::array kCheckedJoints{2, 3, 4, 5};

/// A fault that is to be seen and told from the others: of a joint; of the block; of the stylus.
inline constexpr double kCheckOffsetRadians = 0.1e-3;

/// A check that shows less than this by chance alarms; of each of two tests.
inline constexpr double kCheckAlarmP = 0.005;
/// A cause that leaves so little to chance does not explain the check alone.
inline constexpr double kCauseP = 0.001;

/// A touch this far from where it was is another one.
inline constexpr double kSameTouchMetres = 5e-3;

/// The mean of the first checks.
struct CheckReference {
  std::vector<Touch> touches;   // of the first of them
  Eigen::VectorXd distances_m;  // mean of each touch's
  int count = 0;
  TouchNoise noise;  // of one touch, by how they scatter beside the arm's growth
};

struct CheckRefusal {
  std::string message;  // one sentence with the remedy
};

/// One of the first checks.
struct ReferenceTime {
  std::vector<Touch> touches;
  /// Of the artefact as warm as it was then, one for each face; empty: as the record has it now. A block of
  /// 150 mm that is 5 K warmer grows by as much as a touch scatters, or more.
  std::vector<ContactSurface> contact_planes = {};
};

/// Why these are not the touches of the reference made again, in one sentence with the remedy: another number
/// or order of them, another face, a joint that is not finite, a touch kSameTouchMetres from where it was.
/// Nothing where they are. `arm`: the nominal one, so that it can be told without an identification.
std::optional<CheckRefusal> why_other_touches(const KinematicModel& arm, std::span<const Touch> reference,
                                              std::span<const Touch> touches);

/// Why these checks, one or more, cannot be of one reference, however many are still to come: too few
/// touches, a plane that the block does not have, why_other_touches(), no scatter of two and more. Nothing
/// where they can. How much they scatter is not judged: it is what later checks are held against.
std::optional<CheckRefusal> why_no_reference(const CalibrationRecord& record,
                                             std::span<const ReferenceTime> times);

/// From kReferenceCount times the same touches, in the same order. Refused: fewer of them,
/// why_no_reference().
std::variant<CheckReference, CheckRefusal> make_reference(const CalibrationRecord& record,
                                                          std::span<const ReferenceTime> times);

enum class CheckCause { kNone, kJoint, kBlock, kStylus, kUnknown };

/// Of joint 2, 3, 4 or 5, beside the arm's growth, as if it alone had changed.
struct CheckedJoint {
  int joint = 2;
  double offset_rad = 0.0;  // since the reference
  double std_rad = 0.0;
};

struct CheckVerdict {
  double chi_square = 0.0;  // beside the arm's growth
  double degrees_of_freedom = 0.0;
  double p = 1.0;        // F against the reference's scatter
  double joint_p = 1.0;  // of the most striking joint, times their number
  double rms_m = 0.0;    // of what the growth leaves, by its degrees of freedom
  std::array<CheckedJoint, kCheckedJoints.size()> joints;
  double growth = 0.0;  // of the arm since the reference, a share of its lengths; 1e-6 is a ppm
  double std_growth = 0.0;
  bool alarm = false;
  CheckCause cause = CheckCause::kNone;  // the one that explains the check with the least, of an alarm
  int joint = 0;                         // of kJoint, 2 to 5
  Eigen::VectorXd changes_m;             // of each touch's distance since the reference

  /// The temperature that the growth stands for; nothing where the arm's expansion is unknown.
  [[nodiscard]] std::optional<double> warmer_k(double expansion_per_k) const {
    return expansion_per_k > 0.0 ? std::optional(growth / expansion_per_k) : std::nullopt;
  }
};

/// Refused as make_reference() does.
std::variant<CheckVerdict, CheckRefusal> check(const CalibrationRecord& record,
                                               const CheckReference& reference,
                                               std::span<const Touch> touches);

}  // namespace calib
