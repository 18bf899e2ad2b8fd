#include "config/targets_file.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

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
  try {
    static_cast<void>(nlohmann::json(bytes).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {  // no UTF-8
    return false;
  }
}

/// What is wrong with the name of a target; nothing when it is right. A name is the same in JSON and CSV.
std::optional<std::string> wrong_name(const std::string& name, const std::set<std::string>& taken) {
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

void demand_world(const JsonObject& object) {
  const auto frame = object.find("frame");
  if (!frame) return;
  const std::string name = frame->text();
  if (name == kWorldFrame) return;
  frame->fail("is " + in_quotes(name) +
              ", but a cell's file has no frames beside the controller's world; give \"" +
              std::string(kWorldFrame) + "\" or leave it out, and the pose in the world");
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

Target target_from_json(const JsonValue& value, const SchemaVersion& version, std::set<std::string>& taken) {
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
  demand_world(object);
  target.wanted = PoseTarget{.world_from_tool = pose_from_json(object),
                             .near_joints = joints_from_json(object.at("near_joints_deg"))};
  return target;
}

/// A line "name,j1,...,j6".
Target target_from_csv(const CsvLine& line, std::string_view text, std::set<std::string>& taken) {
  const auto cells = line.split<1 + kJointCount>(text, "a name and 6 joints");
  Target target{.name = std::string(cells[0])};
  if (const auto wrong = wrong_name(target.name, taken)) line.fail("the name " + *wrong);
  taken.insert(target.name);
  calib::JointVector joints;
  for (int joint = 0; joint < kJointCount; ++joint)
    joints[joint] = line.joint(cells[static_cast<std::size_t>(joint) + 1], joint) * calib::kRadiansPerDegree;
  target.wanted = joints;
  return target;
}

}  // namespace

TargetsFile targets_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes) {
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
  std::set<std::string> taken;
  for (const JsonValue& item : object.at("targets").items(1, kTargetCountMax))
    file.targets.push_back(target_from_json(item, version, taken));
  return file;
}

TargetsFile targets_from_csv(const std::string& source, std::string_view bytes) {
  TargetsFile file;
  std::set<std::string> taken;
  const auto take = [&](const CsvLine& line, std::string_view text) {
    if (file.targets.size() == kTargetCountMax)
      line.fail("more than " + std::to_string(kTargetCountMax) + " targets; split the file");
    file.targets.push_back(target_from_csv(line, text, taken));
  };
  const CsvLine last = take_csv_lines(source, bytes, kTargetsCsvHeader, take);
  if (file.targets.empty()) last.fail("there is no target; add a line for each");
  return file;
}

TargetsFile read_targets(const std::filesystem::path& file) {
  const std::string bytes = read_file_bytes(file, kTargetsSizeMax);
  if (file.extension() == ".csv" || first_line(bytes) == kTargetsCsvHeader)
    return targets_from_csv(file.string(), bytes);
  return targets_from_json(file.string(), bytes, kTargetsSizeMax);
}

}  // namespace cell
