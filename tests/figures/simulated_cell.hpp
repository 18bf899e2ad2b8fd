#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/identification_problem.hpp"
#include "config/read_config.hpp"
#include "service/run/decision_rule.hpp"
#include "service/run/planning_problem.hpp"
#include "tests/calib_core/block_study.hpp"

/// Calibrations of a shipped cell by simulation: an arm and an artefact drawn within what is said of them,
/// and the touches that they give. Nothing but the core and the cell's files.
namespace calib::figures {

inline constexpr int kSeedCount = 100;
inline constexpr double kMicrometres = 1e-6;

double median(std::vector<double> values);

/// The value under which this share of the others is, 0 the least and 1 the greatest.
double quantile(std::vector<double> values, double share);

double root_mean_square(std::span<const double> values);

cell::Cell shipped_cell(const std::string& name);

/// The same with an arm that does not bend and has even gears, as the arms of draw_errors().
cell::Cell rigid_cell(const std::string& name);

/// The arm and the contact planes as they are.
struct Truth {
  KinematicModel arm;
  std::vector<ContactSurface> contact_planes;
};

/// Errors of all 37 parameters, each drawn from its tolerance.
ErrorVector draw_errors(const ErrorTolerances& tolerances, UniformChance& chance);

/// Errors of the faces' offsets, drawn from the certificate: those of two faces with a length between them
/// are correlated. 0 for a face that is estimated in place.
std::vector<double> draw_offset_errors_m(const ArtefactKnowledge& known, UniformChance& chance);

/// An artefact, and what is written down of it: the same, but for the certified lengths.
struct DrawnArtefact {
  ArtefactKnowledge truth;
  ArtefactKnowledge known;
};

/// The artefact that is really there, everything uncertain in `known` drawn from its standard deviation by
/// itself; the certificates' lengths are those of this artefact, as uncertain as they say. Both together know
/// the artefact better than a certificate that counts once: the harder case for an alarm.
DrawnArtefact draw_artefact(const ArtefactKnowledge& known, UniformChance& chance);

/// Postures of the nominal arm on the first `face_count` faces in turn: points, tilts up to the cell's limit
/// and turns are even. Collisions are not looked at.
std::vector<Touch> even_touches(const cell::Cell& cell, int face_count, int per_face, UniformChance& chance);

/// All touches of a recipe's plan in their order.
std::vector<Touch> all_planned_touches(const cell::Cell& cell, const cell::Recipe& recipe);

/// The postures of the cell's workspace box.
TipPostures postures_of_box(const cell::Cell& cell);

/// What a verdict judges of the tip over these postures.
cell::JudgedTip tip_to_judge(const TipPostures& box, const IdentificationResult& result);

/// The touches that a recipe's plan fits: postures of the nominal arm on the nominal faces.
std::vector<Touch> planned_touches(const cell::Cell& cell, const cell::Recipe& recipe);

/// What the probe captures of these touches: the true ball on the true face, but for the noise.
std::vector<Touch> captured(const Truth& truth, std::vector<Touch> touches, double noise_m,
                            UniformChance& chance);

/// Distance between where the ball is and where the model has it, root mean square over the postures.
double tip_error_rms_m(const KinematicModel& model, const KinematicModel& truth,
                       std::span<const JointVector> postures);
/// The same of a ball that is there, one point a posture.
double tip_error_rms_m(const KinematicModel& model, std::span<const JointVector> postures,
                       std::span<const Eigen::Vector3d> true_tips_m);

std::vector<JointVector> joints_of(std::span<const Touch> touches);

/// The postures that region_over_joint_ranges predicts for.
std::vector<JointVector> postures_in(const JointRanges& ranges, int count);

}  // namespace calib::figures
