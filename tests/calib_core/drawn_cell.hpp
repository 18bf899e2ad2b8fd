#pragma once

#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/identification/identify.hpp"
#include "tests/calib_core/block_study.hpp"

/// The TX90 before the paper's block and the plate under it, all with the errors that their makers allow:
/// what is true is drawn from what is known. The same seed gives the same cell on every machine.
namespace calib::drawn {

inline constexpr double kPlaceMetres = 0.012;
inline constexpr double kPlaceRadians = 0.020;

/// The standard deviations of config/arms/tx90.json, and those above for the block's place.
ErrorTolerances tolerances();

/// The block's faces (4) or with the plate (5), a ball of 3 mm, nothing uncertain.
ArtefactKnowledge certain_artefact(std::size_t face_count);

/// The same with the uncertainties of a good cell.
ArtefactKnowledge uncertain_artefact(std::size_t face_count);

/// A ball of 50 mm beside the block, as a face; touched around -y.
Face ball(double cap_half_angle_deg = 100.0);

/// A ring with a bore of 84 mm beside the block, as a face: it opens upwards (-y) 60 mm above the plate, and
/// may be touched from 2 to 42 mm below its mouth, around +x or all around.
Face bore(double wall_half_angle_deg = 180.0);
/// The ring: a box with the bore as a hole.
Box bored_ring();

/// Everything but the touches.
IdentificationProblem problem(const ArtefactKnowledge& knowledge,
                              double touch_noise_m = study::kTouchNoiseMetres);

struct Truth {
  ErrorVector errors = ErrorVector::Zero();
  Eigen::VectorXd artefact_errors;
  KinematicModel arm;
  std::vector<ContactSurface> planes;  // where the ball's centre is at the trigger
};

Truth truth_of(const IdentificationProblem& cell, const ErrorVector& errors,
               const Eigen::VectorXd& artefact_errors);

/// Errors of a real arm's size on the parameters that are identified, so that nothing is regrouped.
ErrorVector errors_on(const std::vector<int>& columns, UniformChance& chance);

/// A face estimated in place is 0.5 mm and 1 mrad from its drawing.
Eigen::VectorXd draw_artefact_errors(const Artefact& artefact, UniformChance& chance);

/// Drawn from the priors.
Truth draw_truth(const IdentificationProblem& cell, UniformChance& chance);

/// How touches are made: which faces in turn, how many touches in all, how far the stylus tilts.
struct Manner {
  int count = 100;
  double tilt_max_rad = radians_from_degrees(45.0);
  std::vector<int> faces;  // all when empty
  double noise_m = study::kTouchNoiseMetres;
  std::vector<Face> block;  // where the points are sampled; tx90::faces() when empty
};

/// Touches of the true arm on the true faces, of even points, tilts and turns.
std::vector<Touch> touches(const Truth& truth, const Manner& manner, UniformChance& chance);

/// How far off the nominal arm believes a touch to be, at most: what an arm is found within before it is
/// touched with.
double nominal_position_error_m(const IdentificationProblem& cell, const std::vector<Touch>& touches);

/// Mean square of the distance between the tips of two arms, over the joint ranges.
double tip_mean_square_over_ranges(const KinematicModel& one, const KinematicModel& other);

/// The same over the postures of touches.
double tip_mean_square_over_touches(const KinematicModel& one, const KinematicModel& other,
                                    const std::vector<Touch>& touches);

}  // namespace calib::drawn
