#include "service/run/compensated_targets.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"

namespace cell {
namespace {

constexpr int kFirstMovedFrame = 2;
constexpr double kRounding = 1e-12;  // of a length or an angle in a file
constexpr const char* kWhatToDo = "give an arm that was calibrated in this cell";

/// The first of a frame's parameters that is too far from the cell's for one arm; nothing when all agree.
std::optional<std::string> difference(const calib::LinkParameters& ours,
                                      const calib::LinkParameters& theirs) {
  const auto turned = [](double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi));
  };
  for (const auto& [key, apart_rad] : {std::pair{"alpha", turned(ours.alpha_rad, theirs.alpha_rad)},
                                       std::pair{"theta", turned(ours.theta_rad, theirs.theta_rad)},
                                       std::pair{"beta", turned(ours.beta_rad, theirs.beta_rad)}}) {
    if (!(apart_rad <= kSameArmRadians))
      return fmt::format("{} is {:.3g} deg from that of the cell's arm", key,
                         calib::degrees_from_radians(apart_rad));
  }
  for (const auto& [key, apart_m] :
       {std::pair{"d", std::abs(ours.d_m - theirs.d_m)}, std::pair{"r", std::abs(ours.r_m - theirs.r_m)}}) {
    if (!(apart_m <= kSameArmMetres))
      return fmt::format("{} is {:.3g} mm from that of the cell's arm", key, calib::mm_from_metres(apart_m));
  }
  return std::nullopt;
}

}  // namespace

void demand_arm_of(const Cell& cell, const Arm& arm, const std::string& arm_source) {
  const auto refuse = [&](const std::string& pointer, const std::string& what) {
    throw ConfigError(arm_source, pointer, what + "; " + kWhatToDo);
  };
  if (arm.name != cell.arm.name)
    refuse("/name",
           fmt::format("is {} but the cell's arm is {}", in_quotes(arm.name), in_quotes(cell.arm.name)));
  const calib::KinematicModel& ours = cell.arm.model;
  const calib::KinematicModel& theirs = arm.model;
  for (std::size_t joint = 0; joint < calib::kJointCount; ++joint) {
    const std::string frame = fmt::format("/frames/{}", joint + 1);
    if (theirs.joint_types[joint] != ours.joint_types[joint])
      refuse(frame + "/joint_type", "is another than that of the cell's arm");
    if (theirs.gains[joint] != ours.gains[joint])
      refuse(frame + "/gain", fmt::format("is {:.9g} but that of the cell's arm is {:.9g}",
                                          theirs.gains[joint], ours.gains[joint]));
  }
  for (std::size_t frame = kFirstMovedFrame; frame < calib::kFrameCount; ++frame) {
    if (const auto what = difference(ours.links[frame], theirs.links[frame]))
      refuse(fmt::format("/frames/{}", frame), *what);
  }
}

void demand_serial_of(const Cell& cell, const Arm& arm, const std::string& arm_source) {
  if (!arm.serial || !cell.arm_serial || *arm.serial == *cell.arm_serial) return;
  throw ConfigError(arm_source, "/serial",
                    fmt::format("is {}, and the cell's file has {} (/arm_serial); {}", in_quotes(*arm.serial),
                                in_quotes(*cell.arm_serial), kWhatToDo));
}

bool is_uncalibrated(const Cell& cell, const Arm& arm) {
  const calib::KinematicModel& ours = cell.arm.model;
  const calib::KinematicModel& theirs = arm.model;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    if (calib::is_place_error(i)) continue;
    if (std::abs(calib::parameter_value(ours, i) - calib::parameter_value(theirs, i)) > kRounding)
      return false;
  }
  return ours.compliance_rad_per_nm == theirs.compliance_rad_per_nm;
}

calib::CompensationTool tool_named(const Cell& cell, const Arm& arm, const std::string& name,
                                   const std::string& source, const std::string& pointer) {
  if (name == kStylusTool) return calib::stylus_tool(cell.arm.model, arm.model);
  if (const auto found = cell.tools.find(name); found != cell.tools.end())
    return calib::drawn_tool(found->second);
  std::string known(kStylusTool);
  for (const auto& [tool, unused] : cell.tools) known += ", " + tool;
  throw ConfigError(source, pointer,
                    fmt::format("is {}, which the cell {} does not have; give one of {}, or add it to the "
                                "\"tools\" of the cell's file",
                                in_quotes(name), cell.name, known));
}

calib::Compensation compensation_in(const Cell& cell, const Arm& arm) {
  return calib::Compensation({.nominal = cell.arm.model,
                              .calibrated = arm.model,
                              .joint_ranges = cell.arm.joint_ranges,
                              .covariance = arm.covariance});
}

namespace {

/// So many of them are worth a thread of their own.
constexpr std::size_t kTargetsOfAThreadMin = 1'000;

calib::CompensatedTarget compensated_one(const calib::Compensation& compensation,
                                         const calib::CompensationTool& tool, const Target& target) {
  if (const auto* pose = std::get_if<PoseTarget>(&target.wanted))
    return compensation.at_pose(tool, pose->world_from_tool, pose->near_joints);
  return compensation.at_joints(tool, std::get<calib::JointVector>(target.wanted));
}

}  // namespace

std::vector<calib::CompensatedTarget> compensated(const calib::Compensation& compensation,
                                                  const calib::CompensationTool& tool,
                                                  const std::vector<Target>& targets, int threads) {
  std::vector<calib::CompensatedTarget> results(targets.size());
  const auto correct = [&](std::size_t from, std::size_t end) {
    for (std::size_t i = from; i < end; ++i) results[i] = compensated_one(compensation, tool, targets[i]);
  };
  const std::size_t parts =
      std::clamp<std::size_t>(targets.size() / kTargetsOfAThreadMin, 1, static_cast<std::size_t>(threads));
  std::vector<std::jthread> others;
  for (std::size_t part = 1; part < parts; ++part)
    others.emplace_back(correct, targets.size() * part / parts, targets.size() * (part + 1) / parts);
  correct(0, targets.size() / parts);
  others.clear();
  return results;
}

std::vector<calib::CompensatedTarget> compensated(const Cell& cell, const Arm& arm,
                                                  const calib::CompensationTool& tool,
                                                  const std::vector<Target>& targets, int threads) {
  return compensated(compensation_in(cell, arm), tool, targets, threads);
}

}  // namespace cell
