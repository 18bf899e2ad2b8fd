#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"
#include "config/block_place.hpp"
#include "config/endpoint.hpp"
#include "config/recipe.hpp"
#include "config/target_frames.hpp"

/// What a robot cell is made of, in SI units. Plain values; read_config.hpp makes them from files.
namespace cell {

/// The maker's figures for the drives; radians at the joint, 0 where they are not given.
struct Gears {
  calib::JointVector ripple_rad = calib::JointVector::Zero();         // amplitude
  calib::JointVector backlash_rad = calib::JointVector::Zero();       // width of the play
  calib::JointVector repeatability_rad = calib::JointVector::Zero();  // standard deviation of a stop

  /// One standard deviation of a joint's position in a posture: a sine, an even spread over the play, a stop.
  [[nodiscard]] calib::JointVector std_rad() const {
    return (ripple_rad.cwiseAbs2() / 2.0 + backlash_rad.cwiseAbs2() / 12.0 + repeatability_rad.cwiseAbs2())
        .cwiseSqrt();
  }
  /// One standard deviation of the lag of each joint behind its drive, half of the play: of at most that
  /// width and the likelier the nearer to it.
  [[nodiscard]] calib::JointVector lag_std_rad() const { return backlash_rad / std::sqrt(8.0); }
};

/// How an arm warms up: the maker's figures.
struct Growth {
  double expansion_per_k = 0.0;
  double rise_k = 0.0;  // from cold to warm
};

struct Arm {
  std::string name;
  std::optional<std::string> serial;  // of the very robot that was calibrated; an arm's type has none
  calib::KinematicModel model;
  calib::JointRanges joint_ranges;
  calib::JointVector joint_speeds_max;  // rad/s
  std::vector<calib::Capsule> bodies;
  calib::ErrorTolerances std_errors{};
  /// One standard deviation of what the arm does beside rigid kinematics; empty where it is unknown.
  calib::NongeometricDeviations nongeometric_std{};
  Gears gears;
  std::optional<Growth> growth;
  /// Of a calibrated arm: true minus as the model has it, in the arm's own frame (calib::in_arm_frame());
  /// nothing where it is unknown.
  std::optional<calib::ArmCovariance> covariance;
};

/// The temperature of the block as somebody measured it.
struct BlockTemperature {
  double celsius = 0.0;
  double std_k = 0.0;
  std::optional<std::chrono::system_clock::time_point> measured_at;  // nothing: nobody says when

  bool operator==(const BlockTemperature&) const = default;
};

struct Block {
  std::string name;
  std::filesystem::path file;                      // where it was read from
  std::optional<std::string> serial;               // as engraved; nothing: unknown
  std::map<std::string, std::string> certificate;  // texts for people
  std::optional<double> temperature_c;             // as measured; unknown is not 20
  double std_temperature_k = 0.0;
  std::optional<std::chrono::system_clock::time_point> temperature_at;  // when; nothing: it always holds
  std::optional<double> thermal_expansion_per_k;                        // unknown is not 0
  std::vector<calib::Face> faces;                                       // at 20 degrees C
  std::vector<calib::FaceUncertainty> face_uncertainties;               // one a face
  std::vector<calib::KnownLength> lengths;
  std::vector<calib::Box> solids;
  std::vector<BlockPlace> places;  // beside the first one, where the block is located
};

/// What the tip is called whose ball is the origin of R_7.
inline constexpr const char* kFirstTip = "first";

/// A further tip of a star stylus, beside the one whose ball is the origin of R_7. Where its ball really is,
/// the touches with it find.
struct ProbeTip {
  std::string name;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();    // of its ball by the drawing, in R_7
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // of its stem, out of the tip; in R_7
  double within_m = 0.0;                                 // how far from center_m it may be
  double radius_m = 0.0;
  double std_radius_m = 0.0;
};

struct Probe {
  std::string name;
  std::optional<std::string> serial;
  std::map<std::string, std::string> certificate;
  calib::Stylus stylus;
  bool tip_is_contact_point = false;  // no ball: stylus is all zero
  double std_stylus_radius_m = 0.0;
  double std_pretravel_m = 0.0;
  double std_pretravel_tilt_m = 0.0;
  double std_lobes_m = 0.0;
  double overtravel_m = 0.0;
  double calibration_speed_m_s = 0.0;  // of a contact; the pre-travel holds at this speed only
  std::vector<calib::Capsule>
      bodies;  // in frame 7: its origin is the ball's centre, its z axis points out of the tip
  std::vector<ProbeTip> tips;  // of a star stylus; empty: it has the one tip
};

/// How a tool touches by itself, or a setting pin in its place: a ball about the tool's centre.
struct TouchingTip {
  double radius_m = 0.0;  // 0: a point
  double std_radius_m = 0.0;
  double noise_m = 0.0;  // one standard deviation of a contact along the normal
};

/// What a qualification of the probe allows; nothing is no limit.
struct ProbeLimits {
  std::optional<double>
      scatter_max_m;  // one standard deviation of repeats; nothing: touch_noise_m of the cell
  std::optional<double> run_out_max_m;  // of the ball about the stylus, from where the model has it
  std::optional<double> lobes_max_m;    // amplitude
  std::optional<double> step_max_m;     // of a known length as the calibrated arm measures it
};

/// A run is accepted when the held-out touches, on every plane, and the fit stay within these.
struct AcceptanceLimits {
  double held_out_mean_max_m = 0.0;  // |mean distance - reference|
  double held_out_rms_max_m = 0.0;
  double condition_number_max = 0.0;
  double lack_of_fit_p_min = 0.001;         // residuals less likely than this are not touch noise
  std::optional<double> tip_box_rms_max_m;  // predicted tip uncertainty over the workspace box
  std::optional<double> tip_box_max_m;      // expanded tip uncertainty, k = 2, where it is worst in the box
  std::map<std::string, double> tip_box_max_by_recipe_m;  // in place of tip_box_max_m, by a recipe's name
  std::map<std::string, double> tool_box_rms_max_m;       // as tip_box_rms_max_m, by the name of a tool
  /// Of the distances from the block in a proof; that of calib::ProofLimits when absent.
  std::optional<double> proof_rms_max_m;
  ProbeLimits probe;
  /// A limit is kept only when the value and its expanded uncertainty are within it (ISO 14253-1); else when
  /// the value is.
  bool guarded = false;
  /// How far the reference place may seem to move during a run; reference_drift_max_m() of
  /// touch_judgement.hpp when absent.
  std::optional<double> reference_drift_max_m;

  /// Of a run of this recipe; nothing where neither the recipe nor all have a limit.
  [[nodiscard]] std::optional<double> tip_box_max_of_m(const std::string& recipe) const;
};

/// One standard deviation of the errors of the block's place where the arm's file gives none.
struct PlaceTolerance {
  double length_m = 0.0;
  double angle_rad = 0.0;
};

/// A touch that found its face is made again, slowly: from a little before where the first one stopped.
struct SecondTouch {
  double speed_m_s = 0.0;
  double backoff_m = 0.0;
};

struct Speeds {
  double travel_m_s = 0.0;
  double approach_m_s = 0.0;  // of all that is near to a face and no search
  double search_m_s = 0.0;
  std::optional<SecondTouch> second;  // nothing: the first contact counts

  /// At which the contact that counts is made.
  [[nodiscard]] double contact_m_s() const { return second ? second->speed_m_s : search_m_s; }
};

struct Deadlines {
  std::chrono::milliseconds connect{};
  std::chrono::milliseconds heartbeat_timeout{};  // both sides: silence longer than this is a lost link
  std::chrono::milliseconds command{};            // one touch or travel, as the controller keeps it
  std::chrono::milliseconds ready{600'000};       // for people: touch test, closed cell, power, remote mode
  std::chrono::milliseconds confirm{30'000};      // and then the confirmation at the cell
};

struct Cell {
  std::string name;
  std::filesystem::path file;                // where it was read from
  std::vector<std::filesystem::path> files;  // all that it was read from: itself, arm, block, probe, recipes
  Arm arm;                                   // with the cell's frames 0 and 7
  std::vector<int> own_frames;               // those of the arm that the cell's file gives itself
  std::optional<std::string> arm_serial;     // of this very robot; its arm's file may serve many
  std::optional<std::string> controller_serial;
  Block block;
  Probe probe;
  std::map<std::string, Recipe> recipes;
  std::string default_recipe;
  calib::JointVector park_joints;
  double nominal_position_error_m = 0.0;  // of the tip of the uncalibrated arm
  double place_error_m = 0.0;  // 3 sigma of a located block at the corners of its faces; 0: not located
  PlaceTolerance unknown_place_std;
  double stylus_tilt_max_rad = 0.0;
  std::chrono::minutes block_temperature_age_max = std::chrono::hours(8);  // older ones say nothing of today
  std::optional<std::chrono::days> check_every;  // how often the cell is to be checked; nothing: nobody says
  std::chrono::minutes permit_lifetime{30};      // of a run on hold; then a person confirms it again
  double touch_noise_m = 0.0;  // one standard deviation of a touch along the normal, all in all
  calib::Box workspace_box;
  std::vector<calib::Box> keep_out_boxes;
  std::map<std::string, Eigen::Isometry3d> tools;  // named tool centres: R_6 (wrist centre) from tool
  std::map<std::string, TouchingTip> tool_tips;    // of those that can touch the block themselves
  TargetFrames target_frames;  // that targets may be given in, beside the controller's world
  AcceptanceLimits acceptance;
  Speeds speeds;
  Deadlines deadlines;
  Endpoint controller;

  /// All that may collide: the arm's and the probe's bodies, the block's solids and the keep-out boxes.
  [[nodiscard]] calib::CollisionScene collision_scene() const;
  /// How far, in metres and in any direction, the true faces may be from where a plan of the uncalibrated arm
  /// has them: what every path keeps from them, and what a search reaches to either side. The larger of
  /// nominal_position_error_m and place_error_m.
  [[nodiscard]] double face_error_m() const;
};

/// The cell with its block at this temperature, which outranks that of the block's file; as it is without
/// one.
Cell with_block_temperature(const Cell& cell, const std::optional<BlockTemperature>& given);

/// All that the touches of this cell are measured against, at the block's first place. A block of unknown
/// temperature is taken for one of 20 degrees C, exactly; one of unknown expansion for one that does not
/// expand.
calib::ArtefactKnowledge artefact_knowledge(const Cell& cell);

/// What is known of each error before the first touch: the maker's tolerances, and for the six errors of the
/// block's place that have none, unknown_place_std.
calib::ErrorTolerances prior_tolerances(const Cell& cell);

/// Prismatic joints are not supported by planner, daemon and simulator: throws ConfigError for one.
void demand_revolute(const Cell& cell);

}  // namespace cell
