#include "service/setup/made_arm.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "calib_core/estimation/block_registration.hpp"
#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"

namespace cell {
namespace {

using calib::kJointCount;

// Typical tolerances of an industrial arm, as tx90.json has them; see config/FILES.md.
constexpr double kMadeAngleStdRad = 0.002;
constexpr double kMadeOffsetStdRad = 0.003;
constexpr double kMadeLengthStdMetres = 3e-4;
constexpr double kMadeHarmonicStdRad = 5e-5;
constexpr double kMadeMassShare = 0.05;
constexpr std::array<double, 6> kMadeComplianceStds{0.0, 1e-6, 3e-6, 3e-6, 5e-6, 8e-6};
constexpr std::array<double, 6> kMadeRipplesRad{1.5e-5, 1.5e-5, 2e-5, 3e-5, 3e-5, 4e-5};
constexpr std::array<double, 6> kMadeBacklashRad{2e-5, 2e-5, 2e-5, 4e-5, 4e-5, 5e-5};
constexpr std::array<double, 6> kMadeStopsRad{8e-6, 8e-6, 1e-5, 1.5e-5, 1.5e-5, 2e-5};
// The names say so wherever such a body is in the way.
/// Joints that are nearer to each other meet in one point, and what is between them is a ball.
constexpr double kMadeJointMetres = 0.03;
constexpr const char* kGuessedBodies = "its bodies are guessed";
constexpr std::array<const char*, 6> kMadeBodies{"shoulder (guessed)", "upper arm (guessed)",
                                                 "elbow (guessed)",    "forearm (guessed)",
                                                 "wrist (guessed)",    "flange (guessed)"};

std::optional<double> made_std(const calib::ErrorParameter& parameter) {
  const bool is_place =
      parameter.frame == 0 || (parameter.frame == 1 && parameter.kind != calib::ParameterKind::kBeta);
  if (is_place) return std::nullopt;  // where the arm stands depends on the cell
  if (parameter.is_length()) return kMadeLengthStdMetres;
  if (parameter.frame == calib::kFrameCount - 1 || parameter.kind == calib::ParameterKind::kTheta)
    return kMadeOffsetStdRad;
  return kMadeAngleStdRad;
}

/// A file in another unit than it is read in is a thousand times too small or too large.
void demand_size_of_an_arm(const ArmDescription& description) {
  const double reach_m = made_reach_m(description);
  if (reach_m >= kMadeReachMinMetres && reach_m <= kMadeReachMaxMetres) return;
  throw ConfigError(
      description.source, "",
      fmt::format(
          "the lengths of the arm are {:.4g} m together, and arms from {:g} to {:g} m are made: is the "
          "unit another one? {}",
          reach_m, kMadeReachMinMetres, kMadeReachMaxMetres, description.unit_remedy));
}

/// A capsule from each joint to the next. Its far end lies its own radius before the next joint, where the
/// next one begins: a round end beyond the wrist would hit what is on the flange in every posture. A short
/// one is slimmer than its share, as the wrists of small arms are.
void add_bodies(const ArmDescription& description, const calib::Chain& at_zero, Arm& arm) {
  const double reach_m = made_reach_m(description);
  for (int joint = 1; joint <= kJointCount; ++joint) {
    const auto at = static_cast<std::size_t>(joint);
    const Eigen::Isometry3d frame_from_base = at_zero.block_from_frame[at].inverse();
    const Eigen::Vector3d from_m = frame_from_base * description.joints_and_tip_m[at - 1];
    const Eigen::Vector3d along_m = frame_from_base * description.joints_and_tip_m[at] - from_m;
    const double length_m = along_m.norm(), share_m = kMadeRadiusShares[at - 1] * reach_m;
    const bool is_short = length_m > kMadeJointMetres && share_m > kMadeRadiusOfLengthMax * length_m;
    const double radius_m = is_short ? kMadeRadiusOfLengthMax * length_m : share_m;
    const double left = length_m > radius_m ? 1.0 - radius_m / length_m : 0.0;
    arm.bodies.push_back({kMadeBodies[at - 1], joint, from_m, from_m + left * along_m, radius_m});
  }
}

void add_masses(const ArmDescription& description, const calib::Chain& at_zero, Arm& arm) {
  for (const MadeMass& more : description.masses) {
    if (more.mass_kg <= 0.0) continue;
    const auto frame = static_cast<std::size_t>(more.joint);
    calib::PointMass& mass = arm.model.masses[frame];
    const Eigen::Vector3d center_m = at_zero.block_from_frame[frame].inverse() * more.center_m;
    const double sum_kg = mass.mass_kg + more.mass_kg;
    mass.center_in_frame_m = (mass.mass_kg * mass.center_in_frame_m + more.mass_kg * center_m) / sum_kg;
    mass.mass_kg = sum_kg;
  }
  if (description.masses.empty()) return;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double std = kMadeComplianceStds.at(static_cast<std::size_t>(joint));
    if (std > 0.0) arm.nongeometric_std[static_cast<std::size_t>(calib::compliance_position(joint))] = std;
  }
  for (int frame = 1; frame < calib::kFrameCount; ++frame) {
    if (arm.model.masses[static_cast<std::size_t>(frame)].mass_kg > 0.0)
      arm.nongeometric_std[static_cast<std::size_t>(calib::mass_position(frame))] = kMadeMassShare;
  }
}

calib::JointVector six_of(const std::array<double, kJointCount>& values) {
  return calib::JointVector(values.data());
}

void add_gears(Arm& arm) {
  arm.gears = {.ripple_rad = six_of(kMadeRipplesRad),
               .backlash_rad = six_of(kMadeBacklashRad),
               .repeatability_rad = six_of(kMadeStopsRad)};
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto cosine = static_cast<std::size_t>(calib::harmonic_position(joint));
    arm.nongeometric_std[cosine] = arm.nongeometric_std[cosine + 1] = kMadeHarmonicStdRad;
  }
}

}  // namespace

calib::JointRanges assumed_ranges() {
  return {calib::JointVector::Constant(-calib::radians_from_degrees(180.0)),
          calib::JointVector::Constant(calib::radians_from_degrees(180.0))};
}

calib::JointVector assumed_speeds() {
  return calib::JointVector::Constant(calib::radians_from_degrees(180.0));
}

double made_reach_m(const ArmDescription& description) {
  double reach_m = 0.0;
  for (std::size_t i = 1; i < description.joints_and_tip_m.size(); ++i)
    reach_m += (description.joints_and_tip_m[i] - description.joints_and_tip_m[i - 1]).norm();
  return reach_m;
}

void set_body_radii(MadeArm& made, const std::vector<double>& radii_mm) {
  for (std::size_t i = 0; i < made.arm.bodies.size(); ++i) {
    calib::Capsule& body = made.arm.bodies[i];
    body.radius_m = calib::metres_from_mm(radii_mm.at(i));
    body.name = body.name.substr(0, body.name.find(" ("));
  }
  std::erase_if(made.remarks, [](const std::string& remark) { return remark.starts_with(kGuessedBodies); });
}

MadeArm made_arm(const ArmDescription& description, std::vector<std::string> remarks) {
  demand_size_of_an_arm(description);
  MadeArm made{.remarks = std::move(remarks), .is_placed = description.is_placed};
  Arm& arm = made.arm;
  arm.name = description.name;
  arm.model = description.model;
  arm.joint_ranges = description.ranges;
  arm.joint_speeds_max = description.speeds_max;
  made.base_from_frame1 = calib::block_pose_of(arm.model);
  const Eigen::Vector3d down_in_base =
      description.is_placed ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
  arm.model.down_in_frame_1 = (made.base_from_frame1.linear().transpose() * down_in_base).normalized();
  const calib::Chain at_zero = calib::forward_chain(arm.model, calib::JointVector::Zero());
  const auto& parameters = calib::error_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) arm.std_errors[i] = made_std(parameters[i]);
  add_bodies(description, at_zero, arm);
  add_masses(description, at_zero, arm);
  add_gears(arm);
  made.remarks.push_back(
      "standard deviations of its errors (0.3 mm, 2 and 3 mrad) and figures of its gears are those "
      "of the shipped tx90; put in the maker's");
  double thin_m = arm.bodies.front().radius_m, thick_m = thin_m;
  for (const calib::Capsule& body : arm.bodies) {
    thin_m = std::min(thin_m, body.radius_m);
    thick_m = std::max(thick_m, body.radius_m);
  }
  made.remarks.push_back(fmt::format(
      "{}: capsules along its joints with radii of {:.0f} to {:.0f} mm, by the {:.0f} mm of its "
      "length; measure the arm and correct them before it moves, as all paths are checked with them",
      kGuessedBodies, calib::mm_from_metres(thin_m), calib::mm_from_metres(thick_m),
      calib::mm_from_metres(made_reach_m(description))));
  made.remarks.push_back(
      description.masses.empty()
          ? "its masses are unknown, so that its droop is neither estimated nor in the uncertainty"
          : "the deviations of its compliances and 5 % of its masses are those of the shipped tx90");
  return made;
}

}  // namespace cell
