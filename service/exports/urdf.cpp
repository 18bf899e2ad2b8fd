#include "service/exports/urdf.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>

namespace cell {
namespace {

using calib::kFrameCount;
using calib::kJointCount;

/// Without loss: the shortest text that reads back as the same double.
std::string triple(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

bool is_joint(int frame) { return frame >= 1 && frame <= kJointCount; }

std::size_t place(int frame) { return static_cast<std::size_t>(frame); }

std::string link_name(int frame) {
  if (frame == 0) return "base";
  return is_joint(frame) ? fmt::format("link_{}", frame) : "stylus";
}

/// Roll, pitch and yaw about fixed axes: R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d rpy(const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d yaw_pitch_roll = rotation.eulerAngles(2, 1, 0);
  return yaw_pitch_roll.reverse();
}

void write_link(pugi::xml_node robot, const Arm& arm, int frame) {
  pugi::xml_node link = robot.append_child("link");
  link.append_attribute("name") = link_name(frame).c_str();
  const calib::PointMass& mass = arm.model.masses[place(frame)];
  if (frame == 0 || mass.mass_kg == 0.0) return;
  pugi::xml_node inertial = link.append_child("inertial");
  pugi::xml_node origin = inertial.append_child("origin");
  origin.append_attribute("xyz") = triple(mass.center_in_frame_m).c_str();
  origin.append_attribute("rpy") = "0 0 0";
  inertial.append_child("mass").append_attribute("value") = fmt::format("{}", mass.mass_kg).c_str();
  pugi::xml_node inertia = inertial.append_child("inertia");
  for (const char* moment : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
    inertia.append_attribute(moment) = "0";
}

/// Rot(y,beta) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r) with the joint's motion in it is this constant
/// pose and then the motion: a turn about z and a shift along z may change places.
void write_origin(pugi::xml_node joint, const calib::LinkParameters& link) {
  const Eigen::Isometry3d pose = calib::frame_transform(link);
  pugi::xml_node origin = joint.append_child("origin");
  origin.append_attribute("xyz") = triple(pose.translation()).c_str();
  origin.append_attribute("rpy") = triple(rpy(pose.linear())).c_str();
}

void write_motion(pugi::xml_node joint, const Arm& arm, int frame) {
  const int number = frame - 1;
  const double gain = arm.model.gains[place(number)];
  if (std::abs(gain) != 1.0) {
    throw NotRepresentable(fmt::format(
        "joint {} has the gain {}, and a joint of a URDF has none; export the DH tables, which have a column "
        "for it",
        frame, gain));
  }
  joint.append_child("axis").append_attribute("xyz") = gain > 0.0 ? "0 0 1" : "0 0 -1";
  pugi::xml_node limit = joint.append_child("limit");
  limit.append_attribute("lower") = fmt::format("{}", arm.joint_ranges.lower[number]).c_str();
  limit.append_attribute("upper") = fmt::format("{}", arm.joint_ranges.upper[number]).c_str();
  limit.append_attribute("velocity") = fmt::format("{}", arm.joint_speeds_max[number]).c_str();
  limit.append_attribute("effort") = "0";
}

void write_joint(pugi::xml_node robot, const Arm& arm, int frame) {
  const bool moves = is_joint(frame);
  const bool slides = moves && arm.model.joint_types[place(frame - 1)] == calib::JointType::kPrismatic;
  pugi::xml_node joint = robot.append_child("joint");
  joint.append_attribute("name") =
      moves ? fmt::format("joint_{}", frame).c_str() : (frame == 0 ? "block_to_base" : "link_6_to_stylus");
  joint.append_attribute("type") = moves ? (slides ? "prismatic" : "revolute") : "fixed";
  write_origin(joint, arm.model.links[place(frame)]);
  joint.append_child("parent").append_attribute("link") =
      (frame == 0 ? "block" : link_name(frame - 1)).c_str();
  joint.append_child("child").append_attribute("link") = link_name(frame).c_str();
  if (moves) write_motion(joint, arm, frame);
}

bool has_gear_errors(const calib::KinematicModel& model) {
  const auto is_none = [](const calib::CosSin& wave) { return wave.cos == 0.0 && wave.sin == 0.0; };
  return !(std::ranges::all_of(model.harmonics_rad, is_none) &&
           std::ranges::all_of(model.second_harmonics_rad, is_none) &&
           std::ranges::all_of(model.ripples_rad, is_none));
}

std::string left_out(const calib::KinematicModel& model) {
  const bool bends = std::ranges::any_of(model.compliance_rad_per_nm, [](double c) { return c != 0.0; });
  std::string text;
  if (bends) text += " the droop of its joints under gravity";
  if (has_gear_errors(model)) text += bends ? " and what its gears do" : " what its gears do";
  return text.empty() ? "nothing: the arm is rigid" : text.substr(1);
}

/// A comment must not hold two hyphens.
std::string without_double_hyphens(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at))
    text[at + 1] = ' ';
  return text;
}

std::string comment(const Arm& arm, const std::string& origin) {
  return without_double_hyphens(fmt::format(
      "\n  {}\n"
      "  Metres, radians, kilograms. A joint value is the joint position that the controller shows.\n"
      "  Links: block is the frame of the calibration block, base the foot of the arm in it, link_1 to "
      "link_6\n"
      "  turn with the joints, the origin of stylus is the centre of the stylus ball. The identified errors "
      "are\n"
      "  in the origins of the joints: apply nothing else, and no offsets of the joints' zeros.\n"
      "  Left out, for URDF has no words for it: {}.\n"
      "  Masses are point masses (inertia 0). The effort of a joint is unknown and written as 0.\n",
      origin, left_out(arm.model)));
}

}  // namespace

std::string urdf_document(const Arm& arm, const std::string& origin) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "utf-8";
  document.append_child(pugi::node_comment).set_value(comment(arm, origin).c_str());
  pugi::xml_node robot = document.append_child("robot");
  robot.append_attribute("name") = arm.name.c_str();
  robot.append_child("link").append_attribute("name") = "block";
  for (int frame = 0; frame < kFrameCount; ++frame) write_link(robot, arm, frame);
  for (int frame = 0; frame < kFrameCount; ++frame) write_joint(robot, arm, frame);
  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  return text.str();
}

}  // namespace cell
