#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

namespace sim::testing {

std::string cell_folder(const std::string& name);
cell::Cell read_cell(const std::string& name);
Plant true_plant(const std::string& name);
Plant perfect_plant(const std::string& name);

inline constexpr double kStandoffMetres = 0.015;
inline constexpr double kClearMetres = 0.040;

/// Where on a face and how a touch is aimed.
struct Aim {
  int face = 2;
  double u_m = 0.0;  // from the face's centre along its edges
  double v_m = 0.0;
  double tilt_rad = 0.3;  // stylus axis to inward normal
  double standoff_m = kStandoffMetres;
  double end_depth_m = kStandoffMetres;  // of the search's end below the face
};

struct AimedTouch {
  TouchMotion motion;
  calib::Face face;
  calib::ContactSurface contact_plane;
};

/// A touch that the nominal arm can make from its clear posture: the first turn about the normal and about
/// the stylus, and the first branch, in which it meets nothing on the way there.
AimedTouch aimed_touch(const cell::Cell& cell, const Aim& aim);

/// Where the search trips, if it does.
std::optional<calib::JointVector> search_contact(const Plant& plant, const TouchMotion& motion,
                                                 double noise_m = 0.0);

Eigen::Vector3d tip_m(const calib::KinematicModel& model, const calib::JointVector& joints);

}  // namespace sim::testing
