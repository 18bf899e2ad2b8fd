#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/proof/calibration_record.hpp"

/// Where the tip of a tool is on a calibrated arm, from touches of the block with that tip in place of the
/// probe. With q the centre of the tip in R_6 and A the pose of R_6 by the calibrated arm, a touch is
///
///     distance = signed_distance(face, A q) = 0
///
/// q is estimated without a prior, in the R_6 of the calibrated arm with theta6 as it is nominally: that of
/// the arm is in q and falls out where the tool is used. A tip of another length than the stylus also shows
/// what the stylus could not: which way the axis of joint 6 points. What the touches say of the errors that
/// the calibration left open is estimated with q, given all that it knows: errors of the arm with this tool,
/// and with no other.
namespace calib {

inline constexpr int kToolTouchCount = 8;
inline constexpr int kToolTouchesMin = 5;

/// A tip farther from its drawing than this is that of another tool.
inline constexpr double kToolDrawnWithinMetres = 0.02;

/// A tip farther from its face than this, at the centre that fits best, touched something else.
inline constexpr double kToolFarMetres = 2e-3;

/// A tool and how it touches.
struct ToolTip {
  Eigen::Vector3d drawn_m = Eigen::Vector3d::Zero();  // its centre in R_6 by the drawing
  /// Its radius, less what the ball of the calibration keeps from a face: that ball's radius less its
  /// pre-travel.
  double larger_m = 0.0;
  double std_radius_m = 0.0;
  double noise_m = 0.0;     // one standard deviation of a contact by itself, beside that of the arm
  double std_growth = 0.0;  // of the arm since the calibration, a share of its lengths
};

/// Touches with the tip at `centre_m` (in R_6) as the calibrated arm sees them; a row per touch, metres.
struct ToolRows {
  Eigen::VectorXd distances_m;                         // of the tip from where the estimate has the face
  Eigen::Matrix<double, Eigen::Dynamic, 3> of_centre;  // d distance / d centre in R_6
  Eigen::MatrixXd of_arm;                              // d distance / d ArmVector
  Eigen::MatrixXd of_joints;    // d distance / d position of each joint, metres per radian
  Eigen::MatrixXd of_unknowns;  // d distance / d unknown of the record; 0 of the probe's ball
};

/// The faces of the touches exist and their joints are finite.
ToolRows tool_rows(const CalibrationRecord& record, const ToolTip& tip, const Eigen::Vector3d& centre_m,
                   std::span<const Touch> touches);

/// Of the distances when the centre is right, square metres: contacts, noise as each touch's levers make it,
/// the radius, what the calibration left open, growth.
Eigen::MatrixXd tool_covariance(const CalibrationRecord& record, const ToolTip& tip, const ToolRows& rows,
                                std::span<const Touch> touches);

struct ToolLimits {
  /// Of the tip over the given postures with what the calibration left open; nothing: none.
  std::optional<double> rms_max_m;
  double p_min = 0.01;  // of the chi-square test
};

struct ToolVerdict {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  // in R_6 of the calibrated arm
  /// With this tool the arm has these errors beside those of the calibration: kinematic ones but theta6,
  /// metres and radians; 0 of all others. Of the place too, which counts in the block's frame only.
  ArmVector arm_errors = ArmVector::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  // of it, with all that is not known
  double chi_square = 0.0;                                  // of the distances against their covariance
  double degrees_of_freedom = 0.0;
  double p = 1.0;               // by F where the noise has few degrees of freedom
  double rms_m = 0.0;           // of the distances, by their degrees of freedom
  Eigen::VectorXd distances_m;  // of each touch from its face, at that centre, with those errors
  /// Predicted error of the touched tip over the postures, root mean square: what the calibration left open
  /// counts once, in the arm and in the centre together. Nothing without a posture. In the block's frame, and
  /// in the controller's world, where the place is nominal on both sides.
  std::optional<double> rms_over_postures_m, rms_in_world_m;
  bool passed = false;
  std::vector<std::string> reasons;  // why it did not; one sentence each
};

/// Why there is no verdict: one sentence with the remedy.
struct ToolRefusal {
  std::string message;
};

/// Refused: fewer than kToolTouchesMin touches, a face that does not exist, joints that are not finite,
/// touches that do not determine the centre, a tip that is not as drawn (kToolDrawnWithinMetres), a touch
/// kToolFarMetres from its face.
std::variant<ToolVerdict, ToolRefusal> find_tool_centre(const CalibrationRecord& record, const ToolTip& tip,
                                                        std::span<const Touch> touches,
                                                        std::span<const JointVector> postures,
                                                        const ToolLimits& limits = {});

}  // namespace calib
