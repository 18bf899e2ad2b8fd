#include "config/internal/repeat_reader.hpp"

#include <cmath>
#include <string>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/joint_units.hpp"

namespace cell {
namespace {

constexpr const char* kFirst = "first_joints_deg";
constexpr const char* kAgain = "again_joints_deg";

/// To a thousandth.
std::string figure(double number) { return plain_number(std::round(number * 1e3) / 1e3); }

}  // namespace

RepeatReader::RepeatReader(const Cell& cell, calib::Repeats& repeats)
    : cell_(cell),
      repeats_(repeats),
      nominal_(calib::prepare(cell.arm.model)),
      units_(joint_units(cell.arm.model)) {}

void RepeatReader::demand_second(const JsonObject& touch) {
  if (touch.has("joints_deg")) return;
  if (const auto first = touch.find(kFirst))
    first->fail(
        "is the first contact of a touch without a second; give the second in \"joints_deg\", or "
        "remove the touch");
  if (const auto again = touch.find(kAgain))
    again->fail("repeats a touch without a contact; give the contact in \"joints_deg\", or remove the touch");
}

void RepeatReader::add(const JsonObject& object, const calib::Touch& touch) {
  const bool is_of_the_cell = touch.deviation_m == 0.0;
  if (const auto first = object.find(kFirst)) {
    const calib::JointVector joints =
        demand_same_place(*first, touch, kContactsApartMaxMetres, "the second contact of this touch");
    if (is_of_the_cell) repeats_.two_speed.push_back({touch.face, joints, touch.joints});
  }
  if (const auto again = object.find(kAgain)) {
    const calib::JointVector joints =
        demand_same_place(*again, touch, kRepetitionApartMaxMetres, "the touch that it repeats");
    if (is_of_the_cell) repeats_.touched_again.push_back({touch.face, touch.joints, joints});
  }
}

calib::JointVector RepeatReader::demand_same_place(const JsonValue& joints, const calib::Touch& touch,
                                                   double apart_max_m, std::string_view what) const {
  constexpr const char* kRemedy = "; give joints of the same place in one posture, or remove them";
  calib::JointVector given = joints.numbers<calib::kJointCount>().cwiseProduct(units_);
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    if (cell_.arm.model.joint_types[static_cast<std::size_t>(joint)] != calib::JointType::kRevolute) continue;
    const double apart_rad = std::abs(given[joint] - touch.joints[joint]);
    if (apart_rad <= kPostureApartMaxRad) continue;
    joints.fail("have joint " + std::to_string(joint + 1) + " " +
                figure(calib::degrees_from_radians(apart_rad)) + " deg from " + std::string(what) + kRemedy);
  }
  const auto tip_m = [&](const calib::JointVector& at) {
    return calib::forward_chain(nominal_, at).tip_in_block_m();
  };
  const double apart_m = (tip_m(given) - tip_m(touch.joints)).norm();
  if (apart_m > apart_max_m) {
    joints.fail("lead " + figure(calib::mm_from_metres(apart_m)) + " mm from " + std::string(what) +
                " (by the nominal arm), farther than " + figure(calib::mm_from_metres(apart_max_m)) + " mm" +
                kRemedy);
  }
  return given;
}

}  // namespace cell
