#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/collision.hpp"
#include "calib_core/error_parameters.hpp"
#include "calib_core/face.hpp"
#include "calib_core/joint_vector.hpp"
#include "calib_core/kinematic_model.hpp"
#include "config/endpoint.hpp"
#include "config/recipe.hpp"

/// What a robot cell is made of, in SI units. Plain values; read_config.hpp makes them from files.
namespace cell {

struct Arm {
  std::string name;
  calib::KinematicModel model;
  calib::JointRanges joint_ranges;
  calib::JointVector joint_speeds_max;  // rad/s
  std::vector<calib::Capsule> bodies;
  /// One standard deviation of each error as the maker promises it; nothing where nobody promises anything.
  std::array<std::optional<double>, calib::kErrorParameterCount> std_errors{};
};

/// How well a face of the block is known; nothing where the certificate does not say.
struct FaceTolerance {
  std::optional<double> std_offset_m;
  std::optional<double> std_tilt_rad;
};

/// Two faces of the block that lie a certified length apart.
struct CertifiedLength {
  std::array<int, 2> faces{};  // indices
  double value_m = 0.0;
  double std_m = 0.0;
};

struct Block {
  std::string name;
  std::optional<double> temperature_c;  // as measured; unknown is not 20
  double std_temperature_k = 0.0;
  double thermal_expansion_per_k = 0.0;
  std::vector<calib::Face> faces;
  std::vector<FaceTolerance> face_tolerances;  // one a face
  std::vector<CertifiedLength> lengths;
  std::vector<calib::Box> solids;
};

struct Probe {
  std::string name;
  calib::Stylus stylus;
  bool tip_is_contact_point = false;  // no ball: stylus is all zero
  std::optional<double> std_stylus_radius_m;
  std::optional<double> std_pretravel_m;
  double overtravel_m = 0.0;
  double calibration_speed_m_s = 0.0;  // of a search; the pre-travel holds at this speed only
  std::vector<calib::Capsule>
      bodies;  // in frame 7: its origin is the ball's centre, its z axis points out of the tip
};

/// A run is accepted when the held-out touches, on every plane, stay within these.
struct AcceptanceLimits {
  double held_out_mean_max_m = 0.0;  // |mean distance - reference|
  double held_out_rms_max_m = 0.0;
  double condition_number_max = 0.0;
};

struct Speeds {
  double travel_m_s = 0.0;
  double approach_m_s = 0.0;
  double search_m_s = 0.0;
};

struct Deadlines {
  std::chrono::milliseconds connect{};
  std::chrono::milliseconds heartbeat_timeout{};  // both sides: silence longer than this is a lost link
  std::chrono::milliseconds command{};            // one touch or travel, as the controller keeps it
};

struct Cell {
  std::string name;
  std::filesystem::path file;  // where it was read from
  Arm arm;                     // with the cell's frames 0 and 7
  Block block;
  Probe probe;
  std::map<std::string, Recipe> recipes;
  std::string default_recipe;
  calib::JointVector park_joints;
  double nominal_miss_m = 0.0;
  double stylus_tilt_max_rad = 0.0;
  double touch_noise_m = 0.0;  // one standard deviation of a touch along the normal, all in all
  calib::Box workspace_box;
  std::vector<calib::Box> keep_out_boxes;
  std::map<std::string, Eigen::Isometry3d> tools;  // named tool centres: R_6 (wrist centre) from tool
  AcceptanceLimits acceptance;
  Speeds speeds;
  Deadlines deadlines;
  Endpoint controller;

  /// All that may collide: the arm's and the probe's bodies, the block's solids and the keep-out boxes.
  [[nodiscard]] calib::CollisionScene collision_scene() const;
};

}  // namespace cell
