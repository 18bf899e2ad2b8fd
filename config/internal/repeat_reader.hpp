#pragma once

#include <string_view>

#include "calib_core/estimation/repeat_sources.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "config/cell.hpp"
#include "config/json_value.hpp"

namespace cell {

/// Two contacts of one touch are within this of each other, by the nominal arm: a run allows a tenth of it.
inline constexpr double kContactsApartMaxMetres = 1e-3;

/// A touch and its repetition are: where on the face it is made depends on what is known of the arm.
inline constexpr double kRepetitionApartMaxMetres = 5e-3;

/// In both the joints of one posture are within this of each other.
inline constexpr double kPostureApartMaxRad = 0.035;

/// Reads from the touches of a file what each was touched a second time: `first_joints_deg`, the first
/// contact of a two-speed touch, and `again_joints_deg`, the contact of a repetition that was believed.
class RepeatReader {
 public:
  /// Both must outlive it.
  RepeatReader(const Cell& cell, calib::Repeats& repeats);

  /// ConfigError for a first contact or a repetition of a touch that has no contact.
  static void demand_second(const JsonObject& touch);
  /// ConfigError where one is of another place or posture than the touch. One of a touch with a noise of its
  /// own is checked and not used: it says nothing of the others.
  void add(const JsonObject& object, const calib::Touch& touch);

 private:
  calib::JointVector demand_same_place(const JsonValue& joints, const calib::Touch& touch, double apart_max_m,
                                       std::string_view what) const;

  const Cell& cell_;
  calib::Repeats& repeats_;
  calib::PreparedModel nominal_;
  calib::JointVector units_;
};

}  // namespace cell
