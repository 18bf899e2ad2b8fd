#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/motion/collision.hpp"
#include "config/cell.hpp"

namespace cell {

inline constexpr std::string_view kTruthSchema = "touchcal/truth/4";
inline constexpr std::string_view kThirdTruthSchema = "touchcal/truth/3";   // no tips of the probe
inline constexpr std::string_view kSecondTruthSchema = "touchcal/truth/2";  // no places of the block
inline constexpr std::string_view kRigidTruthSchema = "touchcal/truth/1";   // name and errors only

/// The arm gives way under its own weight: compliance of its joints in place of the arm file's.
struct Droop {
  std::array<double, calib::kJointCount> compliance_rad_per_nm{};
};

/// A gear's uneven transmission: the joint stands amplitude * sin(periods * position + phase) too far.
struct Ripple {
  double amplitude_rad = 0.0;
  double periods_per_turn = 0.0;
  double phase_rad = 0.0;
};

struct Warming {
  double arm_expansion_per_k = 0.0;
  double arm_rise_k = 0.0;           // what the arm's temperature approaches while it is powered, cold = 0
  double arm_time_constant_s = 1.0;  // of that, and of cooling down
  double block_warmer_k = 0.0;       // than the block's file says; with the expansion of that file
};

/// What the probe really is. Pre-travel = pretravel_m + s^2 (tilt_m + lobes_m cos 3 (a -
/// lobe_direction_rad)), s the sine of the angle between stylus axis and the push on the ball, a the push's
/// direction about R_7's z.
struct TrueProbe {
  std::optional<double> stylus_radius_m;  // nothing: the probe file's
  std::optional<double> pretravel_m;      // nothing: the probe file's
  double pretravel_tilt_m = 0.0;
  double lobes_m = 0.0;
  double lobe_direction_rad = 0.0;
  std::optional<double> noise_m;  // one standard deviation of a trip; nothing: the cell's touch_noise_mm
};

/// How a further place of the block differs from the block's file: along and about the axes of R_-1 of the
/// first place, the rotation vector about the place's own origin.
struct TruePlace {
  std::string name;
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
};

/// How a further tip of a star stylus differs from the probe's file: its ball's centre along the axes of R_7.
struct TrueTip {
  std::string name;
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  std::optional<double> radius_m;  // nothing: the probe file's
};

/// What the simulated cell hides. What is nothing or 0 is as the cell's files say.
struct Truth {
  std::string name;
  std::filesystem::path file;
  calib::ErrorVector errors = calib::ErrorVector::Zero();  // metres and radians; those not in the file are 0
  std::optional<Droop> droop;
  std::array<Ripple, calib::kJointCount> ripple{};
  std::optional<std::array<calib::CosSin, calib::kJointCount>> harmonics_rad;  // of eccentric gears
  calib::JointVector backlash_rad = calib::JointVector::Zero();                // width of the play
  Warming warming;
  std::vector<double> face_offsets_m;  // of each plane outwards, against the block's file; empty: none
  std::vector<Eigen::Vector3d> sphere_shifts_m;  // of each sphere's centre, likewise
  std::vector<Eigen::Vector3d> bore_shifts_m;    // of each bore's axis
  std::vector<Eigen::Vector3d> bore_turns_rad;   // of its direction, a rotation about the middle of its wall
  std::vector<TruePlace> places;                 // those that are not as the block's file has them
  TrueProbe probe;
  std::vector<TrueTip> tips;  // those that are not as the probe's file has them
  calib::JointVector repeatability_rad = calib::JointVector::Zero();  // one standard deviation of a stop
  double encoder_step_rad = 0.0;
};

/// ConfigError. An effect with "on": false is checked and left out.
Truth read_truth(const std::filesystem::path& file);

/// The block's solids where they really stand: faces by their true offsets, then as warm as the block is.
/// ConfigError when the offsets do not fit the block.
std::vector<calib::Box> true_solids(const Truth& truth, const Block& block);

/// How much warmer than 20 degrees C block and stands are.
double true_warmth_k(const Truth& truth, const Block& block);

/// The arm without its effects by temperature and joint: errors and droop. ConfigError when the arm's file
/// has no masses to droop under.
calib::KinematicModel true_model(const Truth& truth, const Arm& arm);

}  // namespace cell
