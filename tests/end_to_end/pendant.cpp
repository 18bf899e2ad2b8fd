#include "tests/end_to_end/pendant.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "service/run/touch_command.hpp"

namespace touchcal::testing {

namespace {

/// Over the face, where the way from elsewhere ends; where the slow part begins; where it would end.
constexpr double kOverMetres = 0.04, kSlowMetres = 0.1e-3, kBehindMetres = -2e-3;
/// A person sees how near things are.
constexpr double kSeenMetres = 0.004;
constexpr double kFastMetresPerSecond = 0.25, kSlowMetresPerSecond = 2e-3;

}  // namespace

Pendant::Pendant(LoopbackCell& loop, cell::Cell there, sim::Plant plant)
    : loop_(loop), there_(std::move(there)), plant_(std::move(plant)) {}

void Pendant::take_over() {
  loop_.inject(R"({"fault":"manual_mode"})");
  loop_.inject(R"({"fault":"power_on"})");
  loop_.run_until([](const cell::Status& status) {
    return status.controller.mode == "manual" && status.controller.powered.value_or(false);
  });
}

void Pendant::hand_back() {
  go(there_.park_joints);
  loop_.inject(R"({"fault":"remote_mode"})");
  loop_.inject(R"({"fault":"power_on"})");
}

void Pendant::jog(const cell::JogOrder& order) {
  if (const auto why_not = loop_.server().jog(order)) throw std::runtime_error("no jog: " + *why_not);
  loop_.run_until([this](const cell::Status&) {
    const std::uint32_t flags = loop_.server().report().flags;
    return (flags & cs8::kSettled) != 0 && (flags & cs8::kQueueEmpty) != 0;
  });
  wait_until_told();
}

/// Until the daemon has heard how the arm stands now. A State that was sent before may still be on its way:
/// on a slow machine that one would be taken for it, and a contact that is left again for none.
void Pendant::wait_until_told() {
  loop_.run_until([this](const cell::Status&) {
    const auto told = loop_.operation().controller_state();
    const cs8::State now = loop_.server().report();
    return told && told->joints == now.joints && told->flags == now.flags;
  });
}

void Pendant::go(const calib::JointVector& joints) {
  const calib::TransferSpace space(plant_.truth, there_.collision_scene(), there_.park_joints, kSeenMetres);
  const auto way = calib::find_path(space, cell::from_wire(loop_.server().report().joints), joints);
  if (!way) throw std::runtime_error("a person finds no way there");
  for (const calib::JointVector& via : *way)
    jog({.joints = via, .move_m = {}, .speed_m_s = kFastMetresPerSecond});
  jog({.joints = joints, .move_m = {}, .speed_m_s = kFastMetresPerSecond});
}

/// The postures in which the ball is at a point of a face, the one nearest to where the arm is first: a hand
/// that is turned little keeps the arm's own errors alike from touch to touch.
std::vector<Pendant::Way> Pendant::ways_to(const calib::Face& face, const Eigen::Vector3d& point_m) const {
  const calib::JointVector here = cell::from_wire(loop_.server().report().joints);
  std::vector<Way> ways;
  for (const double lean_rad : {0.6, 0.3, 0.0}) {
    for (const Eigen::Vector3d& side :
         {face.edge_u, Eigen::Vector3d(-face.edge_u), face.edge_v(), Eigen::Vector3d(-face.edge_v())}) {
      const Eigen::Quaterniond stylus = calib::shortest_rotation(
          Eigen::Vector3d::UnitZ(), std::sin(lean_rad) * side - std::cos(lean_rad) * face.plane.outward);
      for (double turn = 0.0; turn < 6.3; turn += 0.5) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = (stylus * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())).toRotationMatrix();
        pose.translation() = point_m;
        for (const auto& joints : calib::inverse_kinematics(there_.arm.model, there_.arm.joint_ranges, pose))
          ways.push_back({pose, joints});
      }
    }
  }
  std::ranges::stable_sort(ways, {}, [&](const Way& way) { return (way.joints - here).norm(); });
  return ways;
}

void Pendant::touch(int face_index, const Eigen::Vector3d& point_m) {
  std::string why = "out of reach";
  for (const Way& way : ways_to(there_.block.faces[static_cast<std::size_t>(face_index)], point_m)) {
    try {
      touch_in(face_index, way.pose, way.joints);
      return;
    } catch (const std::runtime_error& error) {
      why = error.what();  // this posture is in the way of something
    }
  }
  throw std::runtime_error("a person cannot touch there: " + why);
}

void Pendant::touch_near(int face, const calib::JointVector& joints) {
  touch_in(face, calib::forward_kinematics(plant_.truth, joints), joints);
}

void Pendant::touch_by_word(int face_index, const calib::JointVector& joints,
                            const std::function<void()>& at_contact) {
  const calib::Face& face = there_.block.faces[static_cast<std::size_t>(face_index)];
  const Eigen::Isometry3d true_pose = calib::forward_kinematics(plant_.truth, joints);
  const auto at = [&](double height_m) {
    Eigen::Isometry3d pose = true_pose;
    const double off_m =
        face.plane.outward.dot(pose.translation()) - face.plane.offset_m - plant_.trip_distance_m;
    pose.pretranslate((height_m - off_m) * face.plane.outward);
    return calib::solve_near(plant_.truth, pose, joints).value();
  };
  go(at(kOverMetres));
  jog({.joints = at(0.0), .move_m = {}, .speed_m_s = kSlowMetresPerSecond, .until_touch = false});
  at_contact();
  jog({.joints = at(kOverMetres), .move_m = {}, .speed_m_s = kFastMetresPerSecond, .until_touch = false});
}

void Pendant::touch_in(int face_index, const Eigen::Isometry3d& true_pose, const calib::JointVector& near) {
  const calib::Face& face = there_.block.faces[static_cast<std::size_t>(face_index)];
  const double face_m = face.plane.offset_m + plant_.trip_distance_m;
  const auto at = [&](double height_m) {
    Eigen::Isometry3d pose = true_pose;
    const double off_m = face.plane.outward.dot(pose.translation()) - face_m;
    pose.pretranslate((height_m - off_m) * face.plane.outward);
    const auto joints = calib::solve_near(plant_.truth, pose, near);
    if (!joints || !there_.arm.joint_ranges.contains(*joints)) throw std::runtime_error("out of reach");
    return *joints;
  };
  const calib::JointVector over = at(kOverMetres), slow = at(kSlowMetres), behind = at(kBehindMetres);
  go(over);
  jog({.joints = slow, .move_m = {}, .speed_m_s = kFastMetresPerSecond, .until_touch = false});
  jog({.joints = behind, .move_m = {}, .speed_m_s = kSlowMetresPerSecond});
  if ((loop_.server().report().flags & cs8::kProbeTouched) == 0)
    throw std::logic_error("nothing was touched");
  jog({.joints = over, .move_m = {}, .speed_m_s = kFastMetresPerSecond, .until_touch = false});
}

}  // namespace touchcal::testing
