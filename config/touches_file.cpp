#include "config/touches_file.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/estimation/pure_error.hpp"
#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/internal/csv_line.hpp"
#include "config/internal/repeat_reader.hpp"
#include "config/joint_units.hpp"
#include "config/json_value.hpp"
#include "config/strict_json.hpp"
#include "config/touched_places.hpp"

namespace cell {
namespace {

using calib::kJointCount;

constexpr std::size_t kWarningCountMax = 100;

/// From version 1 on.
constexpr std::array kSchemas{kFirstTouchesSchema, kSecondTouchesSchema, kThirdTouchesSchema, kTouchesSchema};

/// The newest where the document names none of them.
int touches_version_of(const nlohmann::json& document) {
  int version = static_cast<int>(kSchemas.size());
  while (version > 1 && !has_schema(document, kSchemas[static_cast<std::size_t>(version - 1)])) --version;
  if (version == 1 && !has_schema(document, kFirstTouchesSchema)) return static_cast<int>(kSchemas.size());
  return version;
}

std::string rounded(double number) {
  constexpr double kShown = 1e6;  // what a controller resolves; hides the conversion's rounding
  return plain_number(std::round(number * kShown) / kShown);
}

/// A sentence on the joints of one touch that are outside their ranges. `name`: "touch" or "reference touch".
std::string range_warning(std::string_view name, std::size_t number, const calib::JointVector& joints,
                          const Arm& arm) {
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
  return std::string(name) + " " + std::to_string(number) + text.str();
}

void warn_of_ranges(std::string_view name, const std::vector<calib::Touch>& touches, const Arm& arm,
                    std::vector<std::string>& warnings) {
  std::size_t told = 0, untold = 0;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (arm.joint_ranges.contains(touches[i].joints)) continue;
    if (told < kWarningCountMax) {
      warnings.push_back(range_warning(name, i + 1, touches[i].joints, arm));
      ++told;
    } else {
      ++untold;
    }
  }
  if (untold > 0) {
    warnings.push_back(std::to_string(untold) + " more " + std::string(name) +
                       "es have joints outside their ranges");
  }
}

calib::TouchRole role_from_json(const JsonValue& value) {
  const std::string name = value.text();
  if (name == "fit") return calib::TouchRole::kFit;
  if (name == "held_out") return calib::TouchRole::kHeldOut;
  if (name == "proof") return calib::TouchRole::kProof;
  value.fail("is " + in_quotes(name) + R"(; give "fit", "held_out" or "proof")");
}

constexpr NumberRange kNoiseUm{.min = calib::um_from_metres(calib::kTouchDeviationMinMetres),
                               .max = calib::um_from_metres(calib::kTouchDeviationMaxMetres)};

/// Seconds since the first touch; a run does not take a year.
constexpr NumberRange kTimesS{.min = 0.0, .max = 3e7};

/// Which version of the document has a key of a touch first.
void demand_version(const JsonObject& object, const char* key, int version, int since) {
  if (version >= since) return;
  if (const auto value = object.find(key)) {
    value->fail("unknown key \"" + std::string(key) + "\" in a touches document of version " +
                std::to_string(version) + "; raise \"schema\" to " + std::to_string(since));
  }
}

calib::Touch touch_from_json(const JsonValue& value, int version, int face_count,
                             const calib::JointVector& units, RepeatReader& repeats) {
  const JsonObject object = value.object(
      {"plane", "joints_deg", "role", "noise_um", "at_s", "first_joints_deg", "again_joints_deg"});
  demand_version(object, "noise_um", version, 2);
  for (const char* key : {"at_s", "first_joints_deg", "again_joints_deg"})
    demand_version(object, key, version, 3);
  calib::Touch touch;
  repeats.demand_second(object);
  touch.face = object.at("plane").integer(1, face_count) - 1;
  touch.joints = object.at("joints_deg").numbers<kJointCount>().cwiseProduct(units);
  if (const auto role = object.find("role")) touch.role = role_from_json(*role);
  if (const auto at = object.find("at_s")) static_cast<void>(at->number(kTimesS));
  if (const auto noise = object.find("noise_um"))
    touch.deviation_m = calib::metres_from_um(noise->number(kNoiseUm));
  repeats.add(object, touch);
  return touch;
}

/// Repeated touches of one place end within this of each other: a block that moves farther, or an arm that
/// grows by more, is another cell.
constexpr double kSamePlaceMaxMetres = 0.005;
/// Much more than a turning joint must differ by for that.
constexpr double kSamePostureMaxRad = calib::radians_from_degrees(2.0);

/// What the touches of the reference place are compared with: the first of them, and its plane by the nominal
/// arm.
class ReferencePosture {
 public:
  ReferencePosture(const Cell& cell, const Recipe& recipe)
      : cell_(cell),
        nominal_(calib::prepare(cell.arm.model)),
        planes_(calib::make_artefact(artefact_knowledge(cell, recipe)).contact_planes) {}

  /// The block stands at another place: another spot on it is touched again and again.
  void begin_place() { first_.reset(); }

  /// ConfigError at `joints` unless `touch` is near its plane, and where the first one was made.
  void demand(const calib::Touch& touch, const JsonValue& joints) {
    const calib::ContactSurface& plane = planes_[static_cast<std::size_t>(touch.face)];
    const Eigen::Vector3d tip_m =
        calib::ball_at_m(plane, calib::forward_chain(nominal_, touch.joints).block_from_frame.back());
    const double off_m = calib::signed_distance_m(plane, tip_m);
    if (std::abs(off_m) > calib::kFarOffMetres) {
      joints.fail("lead " + millimetres(std::abs(off_m)) + " off plane " + std::to_string(touch.face + 1) +
                  " (by the nominal arm); correct the plane or the joints, or remove the touch");
    }
    if (!first_) {
      first_ = touch.joints;
      first_tip_m_ = tip_m;
      return;
    }
    demand_same_joints(touch.joints, joints);
    if (const double moved_m = (tip_m - first_tip_m_).norm(); moved_m > kSamePlaceMaxMetres) {
      joints.fail("lead " + millimetres(moved_m) + " from where the first reference touch was made; " +
                  kOnePlace);
    }
  }

 private:
  static constexpr const char* kOnePlace =
      "give touches of one place in one posture, or move this one to \"touches\"";

  static std::string millimetres(double metres) {
    return plain_number(std::round(calib::mm_from_metres(metres) * 1e3) / 1e3) + " mm";
  }

  void demand_same_joints(const calib::JointVector& joints, const JsonValue& value) const {
    for (int joint = 0; joint < kJointCount; ++joint) {
      if (cell_.arm.model.joint_types[static_cast<std::size_t>(joint)] != calib::JointType::kRevolute)
        continue;
      const double apart_rad = std::abs(joints[joint] - (*first_)[joint]);
      if (apart_rad <= kSamePostureMaxRad) continue;
      value.fail("have joint " + std::to_string(joint + 1) + " " +
                 rounded(calib::degrees_from_radians(apart_rad)) + " deg from the first reference touch; " +
                 kOnePlace);
    }
  }

  const Cell& cell_;
  calib::PreparedModel nominal_;
  std::vector<calib::ContactSurface> planes_;
  std::optional<calib::JointVector> first_;
  Eigen::Vector3d first_tip_m_ = Eigen::Vector3d::Zero();
};

/// Of the reference touches, while each so far has one.
class ReferenceTimes {
 public:
  void add(const JsonObject& reference) {
    const auto at = reference.find("at_s");
    all_known_ = all_known_ && at;
    if (!at) return;
    const double time_s = at->number(kTimesS);
    if (!times_s_.empty() && time_s < times_s_.back()) {
      at->fail("is " + plain_number(time_s) + " but an earlier reference touch was made at " +
               plain_number(times_s_.back()) + "; give the reference touches in the order of their making");
    }
    times_s_.push_back(time_s);
  }
  [[nodiscard]] std::vector<double> take() {
    if (!all_known_) times_s_.clear();
    return std::move(times_s_);
  }

 private:
  std::vector<double> times_s_;
  bool all_known_ = true;
};

int touched_face_count(const Cell& cell, const Recipe& recipe) {
  return place_count(recipe) * faces_per_place(cell.block, recipe);
}

/// While the block stands at one place, all on one plane and in one posture.
void read_references(const JsonValue& value, int version, const Cell& cell, const Recipe& recipe,
                     calib::Repeats& repeats) {
  const int face_count = touched_face_count(cell, recipe);
  const calib::JointVector units = joint_units(cell.arm.model);
  ReferencePosture posture(cell, recipe);
  std::vector<calib::Touch>& references = repeats.references;
  ReferenceTimes times;
  for (const JsonValue& item : value.items(0, kTouchCountMax)) {
    const JsonObject object = item.object({"plane", "joints_deg", "at_s"});
    demand_version(object, "at_s", version, 3);
    const JsonValue plane = object.at("plane");
    const JsonValue joints = object.at("joints_deg");
    const calib::Touch touch{.face = plane.integer(1, face_count) - 1,
                             .joints = joints.numbers<kJointCount>().cwiseProduct(units)};
    if (!references.empty() && touch.face != references.back().face) {
      const int before = references.back().face;
      if (place_of_face(cell.block, recipe, touch.face) <= place_of_face(cell.block, recipe, before))
        plane.fail("is " + std::to_string(touch.face + 1) + " but the first reference touch is on plane " +
                   std::to_string(before + 1) + "; give the touches of one place");
      posture.begin_place();
    }
    posture.demand(touch, joints);
    times.add(object);
    references.push_back(touch);
  }
  repeats.reference_times_s = times.take();
}

/// Of the repeats of a qualification before the run.
calib::TouchNoise scatter_from_json(const JsonValue& value) {
  constexpr NumberRange kScattersUm{.min = 1e6 * calib::kProbeScatterMinMetres,
                                    .max = 1e6 * calib::kTouchDeviationMaxMetres};
  constexpr NumberRange kFreedoms{.min = 1.0, .max = static_cast<double>(kTouchCountMax)};
  const JsonObject object = value.object({"scatter_um", "degrees_of_freedom"});
  return {calib::metres_from_um(object.at("scatter_um").number(kScattersUm)),
          object.at("degrees_of_freedom").number(kFreedoms)};
}

/// Reference touches that say nothing, or less than their number promises.
void warn_of_references(const std::vector<calib::Touch>& references, const Arm& arm,
                        std::vector<std::string>& warnings) {
  if (references.empty()) return;
  warn_of_ranges("reference touch", references, arm, warnings);
  const std::size_t count = references.size(), counted = calib::counted_readings(references).size();
  if (counted < count) {
    warnings.push_back(std::to_string(count - counted) + " of " + std::to_string(count) +
                       " reference touches have the joints of another one to the last digit: copies, which "
                       "are not counted; give in \"reference_touches\" what each touch has measured");
  }
  if (counted < calib::kReadingCountMin) {
    warnings.push_back(std::to_string(counted) + " reference " +
                       (counted == 1 ? "touch says" : "touches say") +
                       " nothing of noise and drift, they are not used; give at least " +
                       std::to_string(calib::kReadingCountMin) + " in \"reference_touches\", or none");
  }
}

/// A line "plane,j1,...,j6".
calib::Touch touch_from_csv(const CsvLine& line, std::string_view text, int face_count,
                            const calib::JointVector& units) {
  const auto cells = line.split<1 + kJointCount>(text, "a plane and 6 joints");
  calib::Touch touch;
  touch.face = line.integer(cells[0], "plane", 1, face_count) - 1;
  for (int joint = 0; joint < kJointCount; ++joint)
    touch.joints[joint] = line.joint(cells[static_cast<std::size_t>(joint) + 1], joint) * units[joint];
  return touch;
}

}  // namespace

TouchesFile touches_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes,
                              const Cell& cell, const Recipe& recipe) {
  const nlohmann::json document = parse_strict_json(source, bytes, size_max_bytes);
  const int version = touches_version_of(document);
  const JsonObject object = JsonValue(source, document)
                                .document(kSchemas[static_cast<std::size_t>(version - 1)],
                                          {"schema", "arm", "touches", "reference_touches", "qualification"});
  demand_version(object, "qualification", version, 4);
  const JsonValue arm = object.at("arm");
  if (const std::string name = arm.text(); name != cell.arm.name) {
    arm.fail("is " + in_quotes(name) + " but the cell's arm is " + in_quotes(cell.arm.name) +
             "; use this arm's touches or its cell");
  }
  TouchesFile result;
  const int face_count = touched_face_count(cell, recipe);
  const calib::JointVector units = joint_units(cell.arm.model);
  RepeatReader repeats(cell, result.repeats);
  for (const JsonValue& item : object.at("touches").items(0, kTouchCountMax)) {
    result.touches.push_back(touch_from_json(item, version, face_count, units, repeats));
  }
  if (const auto references = object.find("reference_touches"))
    read_references(*references, version, cell, recipe, result.repeats);
  if (const auto qualification = object.find("qualification"))
    result.repeats.qualified = scatter_from_json(*qualification);
  warn_of_ranges("touch", result.touches, cell.arm, result.warnings);
  warn_of_references(result.repeats.references, cell.arm, result.warnings);
  return result;
}

TouchesFile touches_from_csv(const std::string& source, std::string_view bytes, const Cell& cell,
                             const Recipe& recipe) {
  TouchesFile result;
  const int face_count = touched_face_count(cell, recipe);
  const calib::JointVector units = joint_units(cell.arm.model);
  const auto take = [&](const CsvLine& line, std::string_view text) {
    if (result.touches.size() == kTouchCountMax)
      line.fail("more than " + std::to_string(kTouchCountMax) + " touches; split the file");
    result.touches.push_back(touch_from_csv(line, text, face_count, units));
  };
  take_csv_lines(source, bytes, kTouchesCsvHeader, take);
  warn_of_ranges("touch", result.touches, cell.arm, result.warnings);
  return result;
}

TouchesFile read_touches(const std::filesystem::path& file, const Cell& cell, const Recipe& recipe) {
  const std::string bytes = read_file_bytes(file, kTouchesSizeMax);
  if (file.extension() == ".csv" || first_line(bytes) == kTouchesCsvHeader) {
    return touches_from_csv(file.string(), bytes, cell, recipe);
  }
  return touches_from_json(file.string(), bytes, kTouchesSizeMax, cell, recipe);
}

}  // namespace cell
