#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "calib_core/compensation/arm_sides.hpp"
#include "calib_core/compensation/compensation_status.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"

/// Targets for a controller that has the nominal model, such that the calibrated arm reaches what was meant.
///
/// Poses are in the controller's `world`: R_1 with joint 1 at 0 and at its nominal place. What lies before
/// the motion of joint 1 (frames 0 and 1) is nominal on both sides, as the controller's world is kept: theta0
/// r0 alpha1 d1 theta1 r1 and beta1, which a block's place cannot be told from. Frames 2 to 6, droop and
/// gears are the calibrated ones, except theta6, which no touch sees. Of r6 touches see the sum with the
/// stylus' r7 only: it counts as the calibrated model has it, and the shipped recipes leave it nominal there.
/// The nominal arm is rigid with even gears, as a controller has it.
namespace calib {

/// A tool by its pose in R_6 (the wrist's centre) on either arm.
struct CompensationTool {
  Eigen::Isometry3d nominal_frame6_from_tool = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d calibrated_frame6_from_tool = Eigen::Isometry3d::Identity();
  bool is_stylus = false;  // frame 7 is uncertain as the covariance says; another tool is taken for exact
  /// One standard deviation of its centre in the world, wherever it is, in place of what the covariance says:
  /// of a tool that was touched, which is known better than arm and drawing are.
  std::optional<double> std_tip_m = {};
};

/// A tool that was drawn and not touched: the same on both arms.
CompensationTool drawn_tool(const Eigen::Isometry3d& frame6_from_tool);
/// The centre of the stylus ball, which the calibration has touched: frame 7 of either arm.
CompensationTool stylus_tool(const KinematicModel& nominal, const KinematicModel& calibrated);

/// Near a straight wrist or a stretched (or folded) elbow a correction turns joints far: nearer than these a
/// target is refused, nearer than twice these it is warned of. Of the nominal posture and the one to be
/// commanded the nearer counts, by the nominal arm's geometry. Measured: 6 of 1,000 targets take more than
/// three steps, all of them nearer than these; joints turn by up to 33 degrees within 1 degree of a straight
/// wrist, by up to 3.7 from 5 degrees on.
inline constexpr double kWristMarginMinRad = 2.0 * kRadiansPerDegree;
inline constexpr double kElbowMarginMinRad = 4.0 * kRadiansPerDegree;
inline constexpr double kWarnedWithin = 2.0;  // times the two
/// What is left, at most, between the tool of the calibrated arm and the target: metres, and the same figure
/// in radians.
inline constexpr double kCompensationResidualMax = 1e-7;
/// A joint this far outside its range is a rounding.
inline constexpr double kRangeRoundingRad = 1e-6 * kRadiansPerDegree;

enum class CompensationReason {
  kNone,
  kStraightWrist,       // warned or refused; angle_rad: from the straight wrist
  kStretchedElbow,      // warned or refused; angle_rad: from the stretched or folded elbow
  kNominalOutOfReach,   // the nominal arm has no posture there on the side of the near joints
  kNominalOutOfRange,   // joint, angle_rad: where the nominal arm has that joint at the target
  kOutOfReach,          // of the calibrated arm near to the nominal posture
  kOutOfRange,          // joint, angle_rad: where the correction has that joint
  kOtherConfiguration,  // the correction would pass a posture that loses a direction
};

/// The calibrated arm as it is corrected for, from the controller's world to the stylus: nothing before the
/// motion of joint 1, theta6 nominal.
KinematicModel calibrated_in_controllers_world(const KinematicModel& nominal,
                                               const KinematicModel& calibrated);

struct CompensatedTarget {
  CompensationStatus status = CompensationStatus::kRefused;
  CompensationReason reason = CompensationReason::kNone;
  int joint = 0;                      // 1 to 6, of a reason that names one
  double angle_rad = 0.0;             // see the reasons
  std::optional<JointVector> joints;  // to be commanded; nothing when refused
  /// How far the tool would have been off without a correction; nothing where the nominal posture is unknown.
  std::optional<double> moved_m;
  std::optional<double> residual_m;  // distance of the calibrated arm's tool at `joints` from the target
  std::optional<double> tip_std_m;   // standard uncertainty of the tool there; nothing without a covariance
};

struct CompensationProblem {
  KinematicModel nominal;     // six revolute joints
  KinematicModel calibrated;  // the same with errors, compliances, harmonics
  JointRanges joint_ranges;   // of what is commanded
  /// Of the errors of the calibrated arm in its own frame: UncertaintyBudget::covariance() of in_arm_frame().
  /// What is before the motion of joint 1 is nominal on both arms; what that joint errs by from posture to
  /// posture is not, and stands in the row of theta1.
  std::optional<ArmCovariance> covariance;
};

/// Newton's method on the calibrated arm from the nominal posture. Prepared once for many targets; a target
/// takes no heap memory and some microseconds. A target that is refused leaves nothing changed.
class Compensation {
 public:
  /// std::logic_error for a prismatic joint.
  explicit Compensation(const CompensationProblem& problem);

  /// The pose that the nominal arm has at these joints with the tool.
  [[nodiscard]] CompensatedTarget at_joints(const CompensationTool& tool, const JointVector& joints) const;
  /// The pose itself; the configuration and the turns of each joint are those of `near`.
  [[nodiscard]] CompensatedTarget at_pose(const CompensationTool& tool,
                                          const Eigen::Isometry3d& world_from_tool,
                                          const JointVector& near) const;

  /// All postures in which the nominal arm has the tool there, as InverseKinematics::solve() gives them.
  [[nodiscard]] Postures nominal_postures(const CompensationTool& tool,
                                          const Eigen::Isometry3d& world_from_tool) const;
  /// The posture of the nominal arm with the tool there that continues `start`: on its side, each joint
  /// within half a turn of it, whatever its range; nothing when out of reach.
  [[nodiscard]] std::optional<JointVector> nominal_follow(const CompensationTool& tool,
                                                          const Eigen::Isometry3d& world_from_tool,
                                                          const JointVector& start) const;
  /// How the nominal arm is folded at these joints, and which way.
  [[nodiscard]] ArmBend nominal_bend(const JointVector& joints) const;
  [[nodiscard]] ArmSides nominal_sides(const JointVector& joints) const;
  /// The first of these joints to be commanded that is outside its range, 1 to 6; 0 when all are inside.
  [[nodiscard]] int joint_out_of_range(const JointVector& joints) const;

  /// The pose of the tool as the controller computes it.
  [[nodiscard]] Eigen::Isometry3d nominal_world_from_tool(const CompensationTool& tool,
                                                          const JointVector& joints) const;
  /// The pose that the calibrated arm has there.
  [[nodiscard]] Eigen::Isometry3d calibrated_world_from_tool(const CompensationTool& tool,
                                                             const JointVector& joints) const;
  /// The block's frame R_-1 in the controller's world.
  [[nodiscard]] const Eigen::Isometry3d& world_from_block() const { return world_from_block_; }

 private:
  [[nodiscard]] std::optional<JointVector> nominal_posture(const Eigen::Isometry3d& world_from_frame6,
                                                           const JointVector& near) const;
  [[nodiscard]] CompensatedTarget corrected(const CompensationTool& tool,
                                            const Eigen::Isometry3d& world_from_tool,
                                            const JointVector& nominal_joints) const;

  PreparedModel nominal_;              // in the controller's world, ends in R_6
  PreparedModel calibrated_;           // in the controller's world, with the calibrated frame 7 and its mass
  PreparedModel calibrated_at_block_;  // the same in the block's frame: what the covariance is of
  InverseKinematics inverse_;
  JointRanges ranges_;  // widened by the rounding
  Eigen::Isometry3d world_from_block_;
  std::optional<ArmMatrix> covariance_;
};

}  // namespace calib
