#include "sim_controller/jog.hpp"

#include <algorithm>

#include "calib_core/kinematics/inverse_kinematics.hpp"

namespace sim {
namespace {

/// Where the order leads, or nothing.
std::optional<calib::JointVector> target_of(const Plant& plant, const calib::JointVector& from,
                                            const cell::JogOrder& order) {
  calib::JointVector target = order.joints.value_or(from);
  if (order.move_m) {
    Eigen::Isometry3d pose = calib::forward_kinematics(plant.nominal, from);
    pose.pretranslate(*order.move_m);
    const auto joints = calib::solve_near(plant.nominal, pose, from);
    if (!joints) return std::nullopt;
    target = *joints;
  }
  if (!plant.joint_ranges.contains(target)) return std::nullopt;
  return target;
}

}  // namespace

std::optional<std::string> begin_jog(const Plant& plant, Cabinet& cabinet, const cell::JogOrder& order) {
  const Panel& panel = cabinet.panel;
  if (panel.mode != cs8::WorkingMode::kManual) return "the controller is not in manual mode";
  if (!panel.powered || panel.emergency_stop != 0) return "the arm has no power";
  if (panel.held) return "the pendant is on hold";
  if (!is_empty(cabinet.drives) || !is_settled(cabinet.drives)) return "the arm moves";
  const auto target = target_of(plant, cabinet.drives.joints, order);
  if (!target) return "the arm cannot reach that";
  const double speed_m_s = std::min(order.speed_m_s, kJogSpeedMaxMetresPerSecond);
  begin_search(plant, cabinet.world, cabinet.chance);  // each touch by hand trips a little differently too
  if (order.move_m) {
    movel(plant, cabinet.drives, *target, speed_m_s);
  } else {
    movej(plant, cabinet.drives, *target, speed_m_s);
  }
  cabinet.jog = Jog{.until_touch = order.until_touch};
  cabinet.jogged = true;
  return std::nullopt;
}

}  // namespace sim
