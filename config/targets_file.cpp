#include "config/targets_file.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <unordered_set>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/internal/csv_line.hpp"
#include "config/json_value.hpp"
#include "config/schema_version.hpp"
#include "config/shapes.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

using calib::kJointCount;

constexpr std::array kTargetsSchemas{kFirstTargetsSchema, kTargetsSchema};

bool is_text(const std::string& bytes) {
  if (std::ranges::any_of(bytes, [](unsigned char c) { return c < 0x20 || c == 0x7f; })) return false;
  if (std::ranges::all_of(bytes, [](unsigned char c) { return c < 0x80; })) return true;
  try {
    static_cast<void>(nlohmann::json(bytes).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {  // no UTF-8
    return false;
  }
}

/// What is wrong with the name of a target; nothing when it is right. A name is the same in JSON and CSV.
std::optional<std::string> wrong_name(const std::string& name, const std::unordered_set<std::string>& taken) {
  if (name.empty()) return "is empty; give each target a name";
  if (name.size() > kTargetNameSizeMax) {
    return "has " + std::to_string(name.size()) + " bytes; give at most " +
           std::to_string(kTargetNameSizeMax);
  }
  if (!is_text(name)) return "is no text of UTF-8 without control characters; correct it";
  if (name.find_first_of(",\"") != std::string::npos)
    return "is " + in_quotes(name) + "; leave commas and quotes out, a CSV cannot hold them";
  if (trimmed(name) != name) return "is " + in_quotes(name) + "; leave the spaces at its ends out";
  if (taken.contains(name)) return "is " + in_quotes(name) + " as that of an earlier target; give another";
  return std::nullopt;
}

/// Of the frame that the target names, in the controller's world.
Eigen::Isometry3d world_from_frame(const JsonObject& target, const TargetFrames& frames) {
  const auto frame = target.find("frame");
  if (!frame) return Eigen::Isometry3d::Identity();
  const std::string name = frame->text();
  if (const std::string why = why_no_target_frame(frames, name); !why.empty()) frame->fail(why);
  return world_from_target_frame(frames, name);
}

calib::JointVector joints_from_json(const JsonValue& value) {
  return value.numbers<kJointCount>() * calib::kRadiansPerDegree;
}

TargetMove move_from_json(const JsonObject& object, const SchemaVersion& version, bool is_first) {
  const auto move = find_since(kTargetLinesVersion, object, "move", version);
  if (!move) return TargetMove::kJoint;
  const std::string word = move->text();
  if (word == "joint") return TargetMove::kJoint;
  if (word != "line") move->fail("is " + in_quotes(word) + R"(; give "line" or "joint")");
  if (is_first) {
    move->fail(
        R"(is "line", but no target is before the first one; give the start of the line as a target before it, )"
        R"(or "joint")");
  }
  return TargetMove::kLine;
}

Target target_from_json(const JsonValue& value, const SchemaVersion& version, const TargetFrames& frames,
                        std::unordered_set<std::string>& taken) {
  const JsonObject object =
      value.object({"name", "joints_deg", "position_mm", "rotation_deg", "near_joints_deg", "frame", "move"});
  const JsonValue name = object.at("name");
  Target target{.name = name.text()};
  if (const auto wrong = wrong_name(target.name, taken)) name.fail(*wrong);
  target.move = move_from_json(object, version, taken.empty());
  taken.insert(target.name);
  if (const auto joints = object.find("joints_deg")) {
    for (const char* key : {"position_mm", "rotation_deg", "near_joints_deg", "frame"}) {
      if (const auto other = object.find(key))
        other->fail("stands beside \"joints_deg\"; give joints or a pose, not both");
    }
    target.wanted = joints_from_json(*joints);
    return target;
  }
  if (!object.has("position_mm"))
    object.fail(R"(has no pose; give "joints_deg", or "position_mm", "rotation_deg" and "near_joints_deg")");
  target.wanted = PoseTarget{.world_from_tool = world_from_frame(object, frames) * pose_from_json(object),
                             .near_joints = joints_from_json(object.at("near_joints_deg"))};
  return target;
}

std::string name_from_line(const CsvLine& line, std::string_view cell,
                           std::unordered_set<std::string>& taken) {
  std::string name(cell);
  if (const auto wrong = wrong_name(name, taken)) line.fail("the name " + *wrong);
  taken.insert(name);
  return name;
}

calib::JointVector joints_from_line(const CsvLine& line, std::span<const std::string_view> cells) {
  calib::JointVector joints;
  for (int joint = 0; joint < kJointCount; ++joint)
    joints[joint] = line.joint(cells[static_cast<std::size_t>(joint)], joint) * calib::kRadiansPerDegree;
  return joints;
}

/// A line "name,j1,...,j6".
Target target_from_csv(const CsvLine& line, std::string_view text, std::unordered_set<std::string>& taken) {
  const auto cells = line.split<1 + kJointCount>(text, "a name and 6 joints");
  return {.name = name_from_line(line, cells[0], taken),
          .wanted = joints_from_line(line, std::span(cells).subspan(1))};
}

/// A line "name, x, y, z, rx, ry, rz, j1, ..., j6".
Target target_from_robodk(const CsvLine& line, std::string_view text,
                          std::unordered_set<std::string>& taken) {
  constexpr std::array kPoseNames{"X", "Y", "Z", "Rx", "Ry", "Rz"};
  const auto cells =
      line.split<1 + kPoseNames.size() + kJointCount>(text, "a name, a pose of 6 numbers and 6 joints");
  std::array<double, kPoseNames.size()> pose{};
  for (std::size_t i = 0; i < pose.size(); ++i) pose.at(i) = line.number(cells.at(i + 1), kPoseNames.at(i));
  const Eigen::Map<const Eigen::Vector3d> position_mm(pose.data()), angles_deg(pose.data() + 3);
  return {.name = name_from_line(line, cells[0], taken),
          .wanted = PoseTarget{
              .world_from_tool = pose_of_trsf_angles(position_mm * calib::kMetresPerMillimetre,
                                                     angles_deg * calib::kRadiansPerDegree),
              .near_joints = joints_from_line(line, std::span(cells).subspan(1 + kPoseNames.size()))}};
}

using TargetOfLine = Target (*)(const CsvLine& line, std::string_view text,
                                std::unordered_set<std::string>& taken);

std::vector<Target> targets_of_lines(const std::string& source, std::string_view bytes,
                                     std::string_view header, TargetOfLine target_of) {
  std::vector<Target> targets;
  std::unordered_set<std::string> taken;
  const auto take = [&](const CsvLine& line, std::string_view text) {
    if (targets.size() == kTargetCountMax)
      line.fail("more than " + std::to_string(kTargetCountMax) + " targets; split the file");
    targets.push_back(target_of(line, text, taken));
  };
  const CsvLine last = take_csv_lines(source, bytes, header, take);
  if (targets.empty()) last.fail("there is no target; add a line for each");
  return targets;
}

/// What RoboDK itself writes, without joints.
constexpr std::string_view kRobodkPoses = "Name, X, Y, Z, Rx, Ry, Rz";

std::string without_spaces(std::string_view text) {
  std::string result(text);
  std::erase(result, ' ');
  return result;
}

bool begins_as_robodk(std::string_view header) {
  return without_spaces(header).starts_with(without_spaces(kRobodkPoses));
}

}  // namespace

TargetsFile targets_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes,
                              const TargetFrames& frames) {
  const nlohmann::json document = parse_strict_json(source, bytes, size_max_bytes);
  const SchemaVersion version = schema_version(document, "targets document", kTargetsSchemas);
  const JsonObject object = JsonValue(source, document)
                                .document(kTargetsSchemas[static_cast<std::size_t>(version.number - 1)],
                                          {"schema", "tool", "targets", "line_max_mm"});
  TargetsFile file{.version = version.number, .tool = object.at("tool").text(), .names_tool = true};
  if (const auto limit = find_since(kTargetLinesVersion, object, "line_max_mm", version)) {
    file.line_max_m =
        calib::metres_from_mm(limit->number({.min = kLineMaxSmallestMm, .max = kLineMaxLargestMm}));
  }
  std::unordered_set<std::string> taken;
  for (const JsonValue& item : object.at("targets").items(1, kTargetCountMax))
    file.targets.push_back(target_from_json(item, version, frames, taken));
  return file;
}

TargetsFile targets_from_csv(const std::string& source, std::string_view bytes) {
  return {.targets = targets_of_lines(source, bytes, kTargetsCsvHeader, target_from_csv)};
}

TargetsFile targets_from_robodk(const std::string& source, std::string_view bytes) {
  const std::string_view remarks = bytes.substr(0, bytes.size() - without_remarks(bytes).size());
  if (remarks.find(kCorrectedRemark) != std::string_view::npos)
    throw ConfigError(
        source, "",
        "is what touchcal compensate wrote: its poses hold the correction already; give the list "
        "that it was made of");
  const std::string_view header = first_line(without_remarks(bytes));
  if (without_spaces(header) == without_spaces(kRobodkPoses))
    throw ConfigError(source, "",
                      "has poses without joints, which do not say in which configuration the arm takes them; "
                      "add the columns J1 to J6 (target.Joints() in RoboDK)");
  const bool is_ours = without_spaces(header) == without_spaces(kRobodkHeader);
  return {.leaves_frame_open = true,
          .targets = targets_of_lines(source, bytes, is_ours ? header : kRobodkHeader, target_from_robodk)};
}

TargetsFile read_targets(const std::filesystem::path& file, const TargetFrames& frames) {
  const std::string bytes = read_file_bytes(file, kTargetsSizeMax);
  const std::string_view header = first_line(without_remarks(bytes));
  if (begins_as_robodk(header)) return targets_from_robodk(file.string(), bytes);
  if (file.extension() == ".csv" || header == kTargetsCsvHeader)
    return targets_from_csv(file.string(), bytes);
  return targets_from_json(file.string(), bytes, kTargetsSizeMax, frames);
}

}  // namespace cell
