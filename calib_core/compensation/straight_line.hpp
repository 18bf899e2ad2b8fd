#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "calib_core/compensation/compensation.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/units.hpp"

/// Straight lines of the tool between two corrected targets. A controller leads its nominal arm straight from
/// one commanded pose to the next; the errors of the real arm change on the way, so that its tool bows off
/// the line although both ends are right. Corrected points between the ends hold it.
namespace calib {

/// Points of a line that bows too far are at most so far apart. Lines of that length hold
/// kLineDeviationMaxMetres in 95 of 100 (use-and-plant, section 1; tests/figures/compensation_test.cpp).
inline constexpr double kStraightLinePartMetres = 0.05;
/// How far the tool may be off a line, unless another limit is given.
inline constexpr double kLineDeviationMaxMetres = 0.02 * kMetresPerMillimetre;
/// A part that still bows too far is halved so often, at most: points 1.6 mm apart.
inline constexpr int kLineHalvingsMax = 5;
/// A tool that turns further has no shortest way.
inline constexpr double kLineTurnMaxRad = 179.0 * kRadiansPerDegree;
/// A joint that turns further from one sample to the next passes a posture that loses a direction.
inline constexpr double kLineJointStepMaxRad = 90.0 * kRadiansPerDegree;

/// As a program means it: the tool's centre moves straight at a constant speed while the tool turns by the
/// shortest rotation at a constant rate.
struct StraightLine {
  Eigen::Isometry3d world_from_start, world_from_end;  // of the tool, as meant
  JointVector start_joints, end_joints;                // as the two targets were corrected
};

enum class LineReason {
  kNone,
  kHalfTurn,            // the tool turns by more than kLineTurnMaxRad; angle_rad
  kOtherConfiguration,  // the two ends, or two postures on the way, are folded in different ways
  kOtherTurns,          // joint, angle_rad: where the line leads it, full turns from where the end has it
  kJointTurnsFar,       // joint, angle_rad: by how much, over kLineJointStepMaxRad
  kPosture,             // the nominal arm cannot be there: `point`
  kPoint,               // a point that the line needs is refused: `point`
  kStaysOff,            // deviation_m is over the limit after kLineHalvingsMax
};

struct LineCorrection {
  LineReason reason = LineReason::kNone;
  double share = 0.0;       // of a reason: where on the way, 0 to 1
  int joint = 0;            // 1 to 6, of a reason that names one
  double angle_rad = 0.0;   // see the reasons
  CompensatedTarget point;  // likewise, refused, with its reason
  /// In order, without the ends; none where the line needs none or has a reason. Each is ok or warned.
  std::vector<CompensatedTarget> points;
  /// The largest distance of the calibrated arm's tool from the meant line, as it is predicted: with the
  /// points, and without them.
  double deviation_m = 0.0, unsplit_deviation_m = 0.0;
};

/// Points for a line, so that the tool of the calibrated arm is nowhere predicted to be further off it than
/// `deviation_max_m` (over 0). None where it is not without them, else even parts of at most
/// kStraightLinePartMetres, and halves of those that still bow too far. Only the place of the tool's centre
/// is judged, not how the tool is turned on the way.
///
/// Samples are the eighths of parts that are at most kStraightLinePartMetres long and in which the tool turns
/// by at most 12 degrees. Both ends of a part are right and the errors of an arm change slowly, so that what
/// is left is a bow: wherever its top lies between two samples, they see at least 98 per cent of it.
LineCorrection corrected_line(const Compensation& compensation, const CompensationTool& tool,
                              const StraightLine& line, double deviation_max_m);

}  // namespace calib
