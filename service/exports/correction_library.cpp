#include "service/exports/correction_library.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "calib_core/compensation/arm_sides.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/gravity.hpp"
#include "service/base/escaped_markup.hpp"
#include "service/offline_programs/number_places.hpp"
#include "service/offline_programs/trsf_pose.hpp"

namespace cell {
namespace {

using calib::kJointCount;

/// A compliance is some 1e-5 degrees a newton metre: all its digits, and no more than a VAL3 num has.
constexpr int kDecimals = 13;
constexpr double kMillimetres = 1.0;  // a unit of the library, mm
/// What a page of the pendant shows of a text, and VAL3 takes of one.
constexpr std::size_t kWarmthBytesMax = 60;
constexpr std::size_t kTextBytesMax = 128;

/// Elements of a Data: the attributes of each.
using Values = std::vector<std::string>;

std::string number_text(double value) { return stored_number(value, kDecimals); }

void append_data(std::string& file, std::string_view name, std::string_view type, const Values& values,
                 std::string_view access = "private") {
  file += fmt::format("    <Data name=\"{}\" access=\"{}\" xsi:type=\"array\" type=\"{}\" size=\"{}\">\n",
                      name, access, type, values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    file += fmt::format("      <Value key=\"{}\" {} />\n", i, values[i]);
  file += "    </Data>\n";
}

Values numbers(const std::vector<double>& all) {
  Values values;
  for (const double one : all) values.push_back(fmt::format("value=\"{}\"", number_text(one)));
  return values;
}

/// Of each joint.
template <class Of>
Values joint_numbers(const Of& of) {
  std::vector<double> all;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) all.push_back(of(joint));
  return numbers(all);
}

Values text(const std::string& value) { return {fmt::format("value=\"{}\"", escaped_markup(value))}; }

std::string six(const SixNames& names, const SixNumbers& values) {
  std::string attributes;
  for (std::size_t i = 0; i < names.size(); ++i)
    attributes += fmt::format("{}{}=\"{}\"", i == 0 ? "" : " ", names[i], number_text(values[i]));
  return attributes;
}

std::string trsf(const Eigen::Isometry3d& pose) {
  return six(kTrsfNames, trsf_of_pose(pose, {}, kMillimetres));
}

std::string trsf(const Eigen::Vector3d& shift_m) {
  return trsf(Eigen::Isometry3d(Eigen::Translation3d(shift_m)));
}

/// What of frame `frame` does not turn with its joint.
Eigen::Isometry3d before_the_joint(calib::LinkParameters link) {
  link.theta_rad = link.r_m = 0.0;
  return calib::frame_transform(link);
}

/// The masses of frames 1 to 6, what frame 7 carries added to that of the wrist, which it never leaves.
std::array<calib::PointMass, kJointCount> joint_masses(const calib::KinematicModel& model) {
  std::array<calib::PointMass, kJointCount> masses;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) masses[joint] = model.masses[joint + 1];
  const calib::PointMass& held = model.masses.back();
  calib::PointMass& wrist = masses.back();
  const double both_kg = wrist.mass_kg + held.mass_kg;
  if (held.mass_kg == 0.0 || both_kg == 0.0) return masses;
  const Eigen::Vector3d held_m = calib::frame_transform(model.links.back()) * held.center_in_frame_m;
  wrist = {both_kg, (wrist.mass_kg * wrist.center_in_frame_m + held.mass_kg * held_m) / both_kg};
  return masses;
}

/// Postures in which the controller's arm is compared with the nominal one: spread over the ranges, no two
/// joints in step, so that every length and every angle shows.
std::vector<calib::JointVector> compared_postures(const calib::JointRanges& ranges) {
  constexpr std::array kShares{std::array{0.3, 0.6, 0.4, 0.7, 0.25, 0.55},
                               std::array{0.7, 0.35, 0.65, 0.4, 0.8, 0.3},
                               std::array{0.45, 0.5, 0.75, 0.2, 0.65, 0.8}};
  std::vector<calib::JointVector> postures;
  for (const auto& shares : kShares) {
    const Eigen::Map<const calib::JointVector> share(shares.data());
    postures.emplace_back(ranges.lower + share.cwiseProduct(ranges.upper - ranges.lower));
  }
  return postures;
}

void demand(bool holds, const std::string& why) {
  if (!holds) throw std::invalid_argument("touchcal_abs: " + why);
}

void demand_text(const std::string& what, const std::string& value, std::size_t bytes_max) {
  const bool is_plain = std::ranges::all_of(value, [](char c) { return c >= ' ' && c <= '~' && c != '"'; });
  demand(is_plain && value.size() <= bytes_max,
         fmt::format("{} '{}' is no text of VAL3: at most {} letters, digits and signs of ASCII, no '\"'",
                     what, escaped_markup(value), bytes_max));
}

void demand_carried(const CorrectionLibrary& library) {
  for (const calib::KinematicModel* model : {&library.arms.nominal, &library.arms.calibrated}) {
    demand(std::ranges::find(model->joint_types, calib::JointType::kPrismatic) == model->joint_types.end(),
           "the arm has a joint that slides, and points are corrected for six joints that turn");
  }
  const auto is_uneven = [](const calib::CosSin& wave) { return wave.cos != 0.0 || wave.sin != 0.0; };
  const calib::KinematicModel& calibrated = library.arms.calibrated;
  demand(std::ranges::none_of(calibrated.second_harmonics_rad, is_uneven) &&
             std::ranges::none_of(calibrated.ripples_rad, is_uneven),
         "the arm's file has waves of its gears of twice a turn or of their teeth, which no calibration "
         "identifies; give the arm that touchcal export writes");
  demand(
      !library.serial.empty(),
      "the serial number of the arm is not known, and the library would correct on any arm; put it into the "
      "cell's file as /arm_serial, as getVersion(\"ArmSN\") says it, and calibrate, or give it there");
  demand_text("the serial number", library.serial, kTextBytesMax);
  demand_text("the model's hash", library.model, kTextBytesMax);
  demand_text("the warmth", library.warmth, kWarmthBytesMax);
  constexpr double kAgreeRad = 1e-9;
  for (const calib::JointVector& joints : compared_postures(library.arms.joint_ranges)) {
    const calib::ArmBend bend = calib::arm_bend(calib::forward_chain(library.arms.nominal, joints));
    const auto turns = [](double angle_rad, double joint_rad) {
      return std::abs(std::remainder(angle_rad - joint_rad, calib::radians_from_degrees(360.0)));
    };
    demand(turns(bend.elbow_rad, joints[2]) < kAgreeRad && turns(bend.wrist_rad, joints[4]) < kAgreeRad,
           "its joints 3 and 5 at 0 are not the stretched elbow and the straight wrist; the library watches "
           "over these two. Correct the targets offline");
  }
}

void append_chain(std::string& file, const calib::KinematicModel& model) {
  const auto link = [&model](std::size_t joint) -> const calib::LinkParameters& {
    return model.links[joint + 1];
  };
  Values fixed, centres;
  const auto masses = joint_masses(model);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    fixed.push_back(trsf(before_the_joint(link(joint))));
    centres.push_back(trsf(masses[joint].center_in_frame_m));
  }
  const auto waves = [&model](double calib::CosSin::*which) {
    return joint_numbers(
        [&](std::size_t joint) { return calib::degrees_from_radians(model.harmonics_rad[joint].*which); });
  };
  append_data(file, "kFixed", "trsf", fixed);
  append_data(file, "kOffset", "num", joint_numbers([&](std::size_t joint) {
                return calib::degrees_from_radians(link(joint).theta_rad);
              }));
  append_data(file, "kAlong", "num",
              joint_numbers([&](std::size_t joint) { return calib::mm_from_metres(link(joint).r_m); }));
  append_data(file, "kGain", "num", joint_numbers([&](std::size_t joint) { return model.gains[joint]; }));
  append_data(file, "kMass", "num", joint_numbers([&](std::size_t joint) { return masses[joint].mass_kg; }));
  append_data(file, "kCentre", "trsf", centres);
  append_data(file, "kSoft", "num", joint_numbers([&](std::size_t joint) {
                return calib::degrees_from_radians(model.compliance_rad_per_nm[joint]);
              }));
  append_data(file, "kCosine", "num", waves(&calib::CosSin::cos));
  append_data(file, "kSine", "num", waves(&calib::CosSin::sin));
  // newton metres of a kilogram times a millimetre
  const Eigen::Vector3d weight = calib::metres_from_mm(calib::kFreeFall) * model.down_in_frame_1;
  append_data(file, "kWeight", "num", numbers({weight.x(), weight.y(), weight.z()}));
}

void append_comparison(std::string& file, const CorrectionLibrary& library) {
  calib::KinematicModel bare = library.arms.nominal;
  bare.links[0] = bare.links[1] = {};
  bare.links.back() = {.r_m = library.wrist_to_flange_m};
  bare.compliance_rad_per_nm = {};
  bare.harmonics_rad = bare.second_harmonics_rad = bare.ripples_rad = calib::kEvenJoints;
  Values postures, poses;
  for (const calib::JointVector& joints : compared_postures(library.arms.joint_ranges)) {
    SixNumbers joints_deg{};
    for (std::size_t joint = 0; joint < kJointCount; ++joint)
      joints_deg[joint] = calib::degrees_from_radians(joints[static_cast<Eigen::Index>(joint)]);
    postures.push_back(six(kJointNames, joints_deg));
    poses.push_back(trsf(calib::forward_kinematics(bare, joints)));
  }
  append_data(file, "kPosture", "jointRx", postures);
  append_data(file, "kPose", "trsf", poses);
  append_data(file, "kBeside", "trsf", {trsf(Eigen::Vector3d::UnitX()), trsf(Eigen::Vector3d::UnitY())});
}

}  // namespace

std::string correction_library_data(const CorrectionLibrary& library) {
  demand_carried(library);
  std::string file =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
      "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\n  <Datas>\n";
  append_data(file, "kSerial", "string", text(library.serial), "public");
  append_data(file, "kModel", "string", text(library.model), "public");
  append_data(file, "kWarmth", "string", text(library.warmth), "public");
  append_data(file, "kFrom", "num", numbers({static_cast<double>(library.from)}), "public");
  append_data(file, "kUntil", "num", numbers({static_cast<double>(library.valid_until)}), "public");
  append_chain(file, calib::calibrated_in_controllers_world(library.arms.nominal, library.arms.calibrated));
  append_data(file, "kFlange", "trsf", {trsf(Eigen::Vector3d(0.0, 0.0, library.wrist_to_flange_m))});
  append_comparison(file, library);
  return file + "  </Datas>\n</Database>\n";
}

}  // namespace cell
