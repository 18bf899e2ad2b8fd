#include "config/touches_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/joint_units.hpp"
#include "config/json_value.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

using calib::kJointCount;

constexpr std::size_t kWarningCountMax = 100;

std::string rounded(double number) {
  constexpr double kShown = 1e6;  // what a controller resolves; hides the conversion's rounding
  return plain_number(std::round(number * kShown) / kShown);
}

/// A sentence on the joints of one touch that are outside their ranges.
std::string range_warning(std::size_t number, const calib::JointVector& joints, const Arm& arm) {
  const calib::JointVector units = joint_units(arm.model);
  std::ostringstream text;
  const char* separator = ": ";
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double lower = arm.joint_ranges.lower[joint], upper = arm.joint_ranges.upper[joint];
    if (joints[joint] >= lower && joints[joint] <= upper) continue;
    const bool turns = arm.model.joint_types[static_cast<std::size_t>(joint)] == calib::JointType::kRevolute;
    text << separator << "joint " << joint + 1 << " at " << rounded(joints[joint] / units[joint])
         << (turns ? " deg" : " mm") << " is outside " << rounded(lower / units[joint]) << " to "
         << rounded(upper / units[joint]);
    separator = ", ";
  }
  return "touch " + std::to_string(number) + text.str();
}

std::vector<std::string> range_warnings(const std::vector<calib::Touch>& touches, const Arm& arm) {
  std::vector<std::string> warnings;
  std::size_t untold = 0;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (arm.joint_ranges.contains(touches[i].joints)) continue;
    if (warnings.size() < kWarningCountMax) {
      warnings.push_back(range_warning(i + 1, touches[i].joints, arm));
    } else {
      ++untold;
    }
  }
  if (untold > 0)
    warnings.push_back(std::to_string(untold) + " more touches have joints outside their ranges");
  return warnings;
}

calib::TouchRole role_from_json(const JsonValue& value) {
  const std::string name = value.text();
  if (name == "fit") return calib::TouchRole::kFit;
  if (name == "held_out") return calib::TouchRole::kHeldOut;
  if (name == "proof") return calib::TouchRole::kProof;
  value.fail("is " + in_quotes(name) + R"(; give "fit", "held_out" or "proof")");
}

calib::Touch touch_from_json(const JsonValue& value, int face_count, const calib::JointVector& units) {
  const JsonObject object = value.object({"plane", "joints_deg", "role"});
  calib::Touch touch;
  touch.face = object.at("plane").integer(1, face_count) - 1;
  touch.joints = object.at("joints_deg").numbers<kJointCount>().cwiseProduct(units);
  if (const auto role = object.find("role")) touch.role = role_from_json(*role);
  return touch;
}

/// All on one plane.
std::vector<calib::Touch> references_from_json(const JsonValue& value, int face_count,
                                               const calib::JointVector& units) {
  std::vector<calib::Touch> references;
  for (const JsonValue& item : value.items(0, kTouchCountMax)) {
    const JsonObject object = item.object({"plane", "joints_deg"});
    const JsonValue plane = object.at("plane");
    const int face = plane.integer(1, face_count) - 1;
    if (!references.empty() && face != references.front().face) {
      plane.fail("is " + std::to_string(face + 1) + " but the first reference touch is on plane " +
                 std::to_string(references.front().face + 1) + "; give the touches of one place");
    }
    references.push_back(
        {.face = face, .joints = object.at("joints_deg").numbers<kJointCount>().cwiseProduct(units)});
  }
  return references;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view first_line(std::string_view text) { return trimmed(text.substr(0, text.find('\n'))); }

/// Lines of a CSV, with complaints that name the line.
class CsvLine {
 public:
  CsvLine(const std::string& source, std::size_t number) : source_(source), number_(number) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw ConfigError(source_, "", "line " + std::to_string(number_) + ": " + message);
  }

  [[nodiscard]] calib::Touch touch(std::string_view text, int face_count,
                                   const calib::JointVector& units) const {
    const auto cells = split(text);
    calib::Touch touch;
    touch.face = plane(cells[0], face_count) - 1;
    for (int joint = 0; joint < kJointCount; ++joint) {
      touch.joints[joint] = number(cells[static_cast<std::size_t>(joint) + 1], joint) * units[joint];
    }
    return touch;
  }

 private:
  static constexpr std::size_t kCellCount = 1 + kJointCount;

  [[nodiscard]] std::array<std::string_view, kCellCount> split(std::string_view text) const {
    std::array<std::string_view, kCellCount> cells;
    std::size_t count = 0;
    for (std::size_t begin = 0; begin <= text.size(); ++count) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      if (count < kCellCount) cells[count] = trimmed(text.substr(begin, end - begin));
      begin = end + 1;
    }
    if (count != kCellCount) {
      fail("wants a plane and 6 joints, has " + std::to_string(count) +
           " values; separate 7 values by commas");
    }
    return cells;
  }

  [[nodiscard]] int plane(std::string_view text, int face_count) const {
    int plane = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), plane);
    if (error != std::errc{} || end != text.data() + text.size() || plane < 1 || plane > face_count) {
      fail("plane is " + in_quotes(std::string(text)) + "; give a whole number from 1 to " +
           std::to_string(face_count));
    }
    return plane;
  }

  [[nodiscard]] double number(std::string_view text, int joint) const {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) {
      fail("joint " + std::to_string(joint + 1) + " is " + in_quotes(std::string(text)) +
           "; give a finite number");
    }
    if (std::abs(number) > kNumberMax) {
      fail("joint " + std::to_string(joint + 1) + " is " + plain_number(number) + "; give " +
           plain_number(-kNumberMax) + " to " + plain_number(kNumberMax));
    }
    return number;
  }

  const std::string& source_;
  std::size_t number_;
};

}  // namespace

TouchesFile touches_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes,
                              const Cell& cell) {
  const nlohmann::json document = parse_strict_json(source, bytes, size_max_bytes);
  const JsonObject object =
      JsonValue(source, document).document(kTouchesSchema, {"schema", "arm", "touches", "reference_touches"});
  const JsonValue arm = object.at("arm");
  if (const std::string name = arm.text(); name != cell.arm.name) {
    arm.fail("is " + in_quotes(name) + " but the cell's arm is " + in_quotes(cell.arm.name) +
             "; use this arm's touches or its cell");
  }
  TouchesFile result;
  const int face_count = static_cast<int>(cell.block.faces.size());
  const calib::JointVector units = joint_units(cell.arm.model);
  for (const JsonValue& item : object.at("touches").items(0, kTouchCountMax)) {
    result.touches.push_back(touch_from_json(item, face_count, units));
  }
  if (const auto references = object.find("reference_touches"))
    result.references = references_from_json(*references, face_count, units);
  result.warnings = range_warnings(result.touches, cell.arm);
  return result;
}

TouchesFile touches_from_csv(const std::string& source, std::string_view bytes, const Cell& cell) {
  if (first_line(bytes) != kTouchesCsvHeader) {
    CsvLine(source, 1).fail("the header is missing; begin with " + std::string(kTouchesCsvHeader));
  }
  TouchesFile result;
  const int face_count = static_cast<int>(cell.block.faces.size());
  const calib::JointVector units = joint_units(cell.arm.model);
  std::size_t line_number = 1;
  for (std::size_t line_break = bytes.find('\n'); line_break != std::string_view::npos;) {
    const std::size_t begin = line_break + 1;
    line_break = bytes.find('\n', begin);
    const std::string_view text = trimmed(bytes.substr(begin, line_break - begin));  // npos: to the end
    const CsvLine line(source, ++line_number);
    if (text.empty()) continue;
    if (result.touches.size() == kTouchCountMax) {
      line.fail("more than " + std::to_string(kTouchCountMax) + " touches; split the file");
    }
    result.touches.push_back(line.touch(text, face_count, units));
  }
  result.warnings = range_warnings(result.touches, cell.arm);
  return result;
}

TouchesFile read_touches(const std::filesystem::path& file, const Cell& cell) {
  const std::string bytes = read_file_bytes(file, kTouchesSizeMax);
  if (file.extension() == ".csv" || first_line(bytes) == kTouchesCsvHeader) {
    return touches_from_csv(file.string(), bytes, cell);
  }
  return touches_from_json(file.string(), bytes, kTouchesSizeMax, cell);
}

}  // namespace cell
