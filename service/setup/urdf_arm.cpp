#include "service/setup/urdf_arm.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <pugixml.hpp>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "service/setup/axis_chain.hpp"

namespace cell {
namespace {

constexpr std::size_t kUrdfJointsMax = 10'000;

/// A URDF file that is read; each demand that is not met names the joint or link.
class UrdfRobot {
 public:
  UrdfRobot(std::string source, std::string_view text) : source_(std::move(source)) {
    if (text.size() > kUrdfSizeMax)
      fail("", "is larger than 4 MB; a robot's description is not, give the URDF itself");
    const auto parsed = document_.load_buffer(text.data(), text.size());
    if (!parsed)
      fail("", fmt::format("is no XML (byte {}: {}); give a URDF", parsed.offset, parsed.description()));
    robot_ = document_.child("robot");
    if (!robot_) fail("", "has no <robot>; give a URDF");
    demand_no_xacro();
    std::size_t count = 0;
    for (const pugi::xml_node joint : robot_.children("joint")) {
      if (++count > kUrdfJointsMax) fail("/robot", "has too many joints; give the arm alone");
      const std::string child = joint.child("child").attribute("link").value();
      if (!joint_above_.emplace(child, joint).second)
        fail(place(joint),
             fmt::format("link \"{}\" hangs on two joints; a chain has one above each link", child));
    }
  }

  [[noreturn]] void fail(const std::string& where, const std::string& message) const {
    throw ConfigError(source_, where, message);
  }
  [[nodiscard]] static std::string place(pugi::xml_node joint) {
    return fmt::format("/robot/{}[{}]", joint.name(), joint.attribute("name").value());
  }
  [[nodiscard]] std::string name() const {
    const std::string name = robot_.attribute("name").value();
    return name.empty() ? "arm" : name;
  }
  [[nodiscard]] pugi::xml_node link(const std::string& name) const {
    for (const pugi::xml_node link : robot_.children("link"))
      if (name == link.attribute("name").value()) return link;
    return {};
  }

  /// From the base to the tip.
  [[nodiscard]] std::vector<pugi::xml_node> joints_between(const std::string& base,
                                                           const std::string& tip) const {
    for (const std::string& end : {base, tip})
      if (!link(end))
        fail("/robot", fmt::format("has no link {}; its links are {}", in_quotes(end), link_names()));
    std::vector<pugi::xml_node> joints;
    for (std::string at = tip; at != base;) {
      const auto above = joint_above_.find(at);
      if (above == joint_above_.end() || joints.size() > joint_above_.size())
        fail("/robot",
             fmt::format(
                 "link {} does not hang on {}: above it the chain ends at {}; name a base above the tip",
                 in_quotes(tip), in_quotes(base), in_quotes(at)));
      joints.push_back(above->second);
      at = above->second.child("parent").attribute("link").value();
    }
    std::ranges::reverse(joints);
    return joints;
  }

  /// As many numbers as are wanted, of an attribute; nothing where there is none.
  [[nodiscard]] std::optional<std::vector<double>> numbers(pugi::xml_node of, pugi::xml_node element,
                                                           const char* key, std::size_t count) const {
    const pugi::xml_attribute attribute = element.attribute(key);
    if (!attribute) return std::nullopt;
    std::vector<double> values;
    const char* at = attribute.value();
    const char* const end = at + std::strlen(at);
    while (true) {
      while (at != end && std::strchr(" \t\r\n", *at) != nullptr) ++at;
      if (at == end) break;
      if (*at == '+') ++at;
      double value = 0.0;
      const auto [behind, error] = std::from_chars(at, end, value);
      const bool is_last = behind == end || std::strchr(" \t\r\n", *behind) != nullptr;
      if (error != std::errc() || !is_last || !std::isfinite(value) || std::abs(value) > kNumberMax)
        fail(place(of),
             fmt::format("{} {} is {}; give {} finite number(s) below 100000, in metres and radians",
                         element.name(), key, in_quotes(attribute.value()), count));
      values.push_back(value);
      at = behind;
    }
    if (values.size() != count)
      fail(place(of),
           fmt::format("{} {} has {} numbers; give {}", element.name(), key, values.size(), count));
    return values;
  }
  [[nodiscard]] Eigen::Isometry3d origin(pugi::xml_node of, pugi::xml_node element) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const pugi::xml_node node = element.child("origin");
    if (const auto xyz = numbers(of, node, "xyz", 3)) pose.translation() << (*xyz)[0], (*xyz)[1], (*xyz)[2];
    if (const auto rpy = numbers(of, node, "rpy", 3))
      pose.linear() = (Eigen::AngleAxisd((*rpy)[2], Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd((*rpy)[1], Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd((*rpy)[0], Eigen::Vector3d::UnitX()))
                          .toRotationMatrix();
    return pose;
  }

 private:
  void demand_no_xacro() const {
    for (const pugi::xml_node node : robot_.children())
      if (std::string_view(node.name()).starts_with("xacro:"))
        fail("/robot", fmt::format("has <{}>, which is xacro; expand it first: xacro FILE.xacro > FILE.urdf",
                                   node.name()));
  }
  [[nodiscard]] std::string link_names() const {
    constexpr std::size_t kShown = 300;
    std::string names;
    for (const pugi::xml_node link : robot_.children("link")) {
      names += (names.empty() ? "" : ", ") + std::string(link.attribute("name").value());
      if (names.size() > kShown) return names + ", ...";
    }
    return names;
  }

  std::string source_;
  pugi::xml_document document_;
  pugi::xml_node robot_;
  std::map<std::string, pugi::xml_node> joint_above_;  // by the link that hangs on it
};

/// The chain as it is walked from base to tip, in the base, all joints at 0.
struct WalkedChain {
  Eigen::Isometry3d base_from_here = Eigen::Isometry3d::Identity();
  std::vector<JointAxis> axes;
  std::vector<pugi::xml_node> turning;
  std::vector<MadeMass> masses;
};

Eigen::Vector3d axis_of_joint(const UrdfRobot& robot, pugi::xml_node joint) {
  const auto given = robot.numbers(joint, joint.child("axis"), "xyz", 3);
  const Eigen::Vector3d axis =
      given ? Eigen::Vector3d((*given)[0], (*given)[1], (*given)[2]) : Eigen::Vector3d::UnitX();
  if (axis.norm() < 1e-6)
    robot.fail(UrdfRobot::place(joint), "has an axis without a length; give a direction");
  return axis.normalized();
}

void demand_turning(const UrdfRobot& robot, pugi::xml_node joint) {
  const std::string type = joint.attribute("type").value();
  if (type != "revolute" && type != "continuous")
    robot.fail(
        UrdfRobot::place(joint),
        fmt::format(
            "is {}; an arm has six revolute joints, name a base and a tip between which there is no other",
            in_quotes(type)));
  if (joint.child("mimic"))
    robot.fail(UrdfRobot::place(joint),
               "mimics another joint, which an arm's file cannot say; six joints move by themselves");
}

void take_mass(const UrdfRobot& robot, pugi::xml_node joint, WalkedChain& chain) {
  const pugi::xml_node link = robot.link(joint.child("child").attribute("link").value());
  const pugi::xml_node inertial = link.child("inertial");
  const auto mass = robot.numbers(link, inertial.child("mass"), "value", 1);
  if (!mass || (*mass)[0] <= 0.0 || chain.axes.empty()) return;
  chain.masses.push_back({.joint = static_cast<int>(chain.axes.size()),
                          .mass_kg = (*mass)[0],
                          .center_m = chain.base_from_here * robot.origin(link, inertial).translation()});
}

WalkedChain walk(const UrdfRobot& robot, const std::vector<pugi::xml_node>& joints) {
  WalkedChain chain;
  for (const pugi::xml_node joint : joints) {
    chain.base_from_here = chain.base_from_here * robot.origin(joint, joint);
    if (std::string_view(joint.attribute("type").value()) != "fixed") {
      demand_turning(robot, joint);
      chain.axes.push_back(
          {chain.base_from_here.translation(), chain.base_from_here.linear() * axis_of_joint(robot, joint)});
      chain.turning.push_back(joint);
    }
    if (chain.axes.size() > calib::kJointCount) break;
    take_mass(robot, joint, chain);
  }
  if (chain.axes.size() == calib::kJointCount) return chain;
  std::string names;
  for (const pugi::xml_node joint : chain.turning)
    names += (names.empty() ? "" : ", ") + std::string(joint.attribute("name").value());
  robot.fail("/robot",
             fmt::format(
                 "has {} revolute joints between base and tip ({}); an arm has six, name the links "
                 "between which they are",
                 chain.axes.size() > calib::kJointCount ? "more than six" : std::to_string(chain.axes.size()),
                 names));
}

/// Range and speed of a joint; what is not said is remarked.
void read_limits_of(const UrdfRobot& robot, pugi::xml_node joint, int number, ArmDescription& arm,
                    std::vector<std::string>& remarks) {
  const pugi::xml_node limit = joint.child("limit");
  const char* name = joint.attribute("name").value();
  const auto lower = robot.numbers(joint, limit, "lower", 1), upper = robot.numbers(joint, limit, "upper", 1);
  const auto speed = robot.numbers(joint, limit, "velocity", 1);
  const bool is_bounded = std::string_view(joint.attribute("type").value()) == "revolute" && lower && upper;
  if (is_bounded) {
    arm.ranges.lower[number] = (*lower)[0];
    arm.ranges.upper[number] = (*upper)[0];
    if (!((*lower)[0] < (*upper)[0]))
      robot.fail(UrdfRobot::place(joint), "has no lower limit below its upper one; correct <limit>");
  } else {
    remarks.push_back(
        fmt::format("joint {} has no range in the file; -180 to 180 degrees are assumed", name));
  }
  if (speed && (*speed)[0] > 0.0) {
    arm.speeds_max[number] = (*speed)[0];
  } else {
    remarks.push_back(
        fmt::format("joint {} has no speed in the file; 180 degrees a second are assumed", name));
  }
}

}  // namespace

MadeArm arm_of_urdf(const std::string& source, std::string_view text, const std::string& base_link,
                    const std::string& tip_link) {
  const UrdfRobot robot(source, text);
  const WalkedChain chain = walk(robot, robot.joints_between(base_link, tip_link));
  ArmDescription description{.source = source,
                             .unit_remedy = "Lengths of a URDF are metres; convert it",
                             .name = robot.name(),
                             .ranges = assumed_ranges(),
                             .speeds_max = assumed_speeds()};
  std::array<JointAxis, calib::kJointCount> axes;
  std::vector<std::string> remarks;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i] = chain.axes[i];
    description.joints_and_tip_m[i] = chain.axes[i].point_m;
    read_limits_of(robot, chain.turning[i], static_cast<int>(i), description, remarks);
  }
  description.joints_and_tip_m.back() = chain.base_from_here.translation();
  description.model = model_of_axes(axes, chain.base_from_here);
  description.masses = chain.masses;
  return made_arm(description, std::move(remarks));
}

MadeArm arm_of_urdf_file(const std::filesystem::path& file, const std::string& base_link,
                         const std::string& tip_link) {
  return arm_of_urdf(file.string(), read_file_bytes(file, kUrdfSizeMax), base_link, tip_link);
}

}  // namespace cell
