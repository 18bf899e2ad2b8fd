#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/geometry/box.hpp"
#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/motion/motion_time.hpp"

namespace calib {

/// Requested touches on a face.
struct TouchRequest {
  int face = 0;
  int fit_min = 0;
  int fit_max = 0;
  int held_out_count = 0;
};

/// The criterion of the choice of fitted touches.
enum class PlanCriterion {
  kTipInBox,          // smallest predicted tip error over the workspace box
  kTipInJointRanges,  // smallest predicted tip error over the joint ranges
  kInformation,       // largest determinant of the information (D-optimality)
  kConditionNumber,   // smallest condition number of the identifiable columns, metres and radians
};

struct PlanGoal {
  PlanCriterion criterion = PlanCriterion::kTipInBox;
  int fit_count = 0;  // fitted touches on all faces; an upper limit when tip_rms_max_m is given
  /// Wanted accuracy: the fewest touches with a predicted tip error within this limit, root mean square over
  /// the region of the criterion (over the workspace box for criteria without a region).
  std::optional<double> tip_rms_max_m;
};

/// A further tip of the stylus, by the drawing; see ArtefactTip.
struct PlanningTip {
  /// The origin is the centre of its ball; z points along its stem out of the tip.
  Eigen::Isometry3d frame7_from_tip = Eigen::Isometry3d::Identity();
  double radius_m = 0.0;
  double within_m = 0.0;            // how far the ball may be from there
  std::vector<std::size_t> bodies;  // of the scene: its ball and its stem
};

struct PlanningProblem {
  KinematicModel nominal;  // the model that postures are computed with
  JointRanges joint_ranges;
  /// Of every place at which the artefact stands in turn, in the order of the touches' indices; each in the
  /// R_-1 of its own place.
  std::vector<Face> faces;
  Stylus stylus;
  std::vector<PlanningTip> tips;  // beside that of the stylus, in the order of the artefact's
  CollisionScene scene;
  std::vector<TouchRequest> requests;
  PlanGoal goal;
  JointVector park_joints;  // a run begins and ends here; clear of obstacles
  /// Bound on the tip error of `nominal` against the faces, by the arm and by their place: sizes clearance
  /// and search.
  double nominal_position_error_m = 0.012;
  /// A search begins at least this far before its face and ends at least this far behind it.
  double standoff_min_m = 0.015;
  double tilt_max_rad = 0.0;
  std::uint64_t seed = 1;        // of the candidates; the same problem gives the same plan
  int candidate_count = 20'000;  // feasible touches to choose from
  /// The identification that the touches are for: artefact, noise, tolerances; without touches. Its `nominal`
  /// is the arm of the configuration.
  IdentificationProblem knowledge;
  IdentificationOptions identification;
  Box workspace_box;
  MotionLimits motion;
};

/// Bound on the orientation error of the tip by the nominal arm (Table III: 0.016).
inline constexpr double kOrientationErrorMaxRadians = 0.03;

/// The frame in R_7 of the tip that touches a face; R_7 itself for the first one.
Eigen::Isometry3d frame7_from_tip(const PlanningProblem& problem, int face);

/// How far the ball that touches a face may be from where the nominal arm has it: farther than R_7, by the
/// `within_m` of its tip and by what the arm may be turned.
double ball_position_error_m(const PlanningProblem& problem, int face);

/// The problem of the touches of a face by the tip that makes them, as if there were no other: R_7 is the
/// tip's own frame, with the probe's bodies in it, and the position error is that of its ball. A posture is
/// the same joints in both. All of the probe but the tip's own stem is as loose against the ball as the ball
/// itself. The touches of the first tip are those of the problem itself.
PlanningProblem for_tip_of(PlanningProblem problem, int face);

/// Where the ball that touches a face is on it, by the nominal artefact.
ContactSurface touched_surface(const PlanningProblem& problem, int face);

/// Width of the slow zone around everything that may be touched. The probe (all bodies of frame 7 and the
/// tip) moves at approach speed inside it; travel moves stay outside even with the nominal position error.
inline constexpr double kSlowZoneMetres = 0.025;

/// The scene of the problem with the additional margins of travel moves.
CollisionScene travel_scene(const PlanningProblem& problem);

}  // namespace calib
