#include "service/offline_programs/data_filter.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <set>
#include <utility>

#include "config/config_error.hpp"
#include "service/base/digest.hpp"
#include "service/offline_programs/filter_records.hpp"
#include "service/offline_programs/frame_chains.hpp"
#include "service/offline_programs/trsf_pose.hpp"

namespace cell {
namespace {

bool holds_places(StoredKind kind) {
  switch (kind) {
    case StoredKind::kPoint:
    case StoredKind::kJoint:
    case StoredKind::kOtherArm:
    case StoredKind::kUnknown:
      return true;
    case StoredKind::kFrame:
    case StoredKind::kTrsf:
    case StoredKind::kPlain:
      return false;
  }
  return false;
}

/// The list against the file, both ways.
void compare_with_list(const XmlText& xml, const StoredData& data, const FilterList& list) {
  for (const auto& [name, listed] : list.variables)
    if (!data.places.contains(name))
      throw ConfigError(
          list.source + ':' + std::to_string(listed.line), "",
          in_quotes(name) + " is no variable of " + xml.source() + "; correct the name, or remove the line");
  for (const StoredVariable& variable : data.variables) {
    const auto listed = list.variables.find(variable.name);
    const bool is_offline = listed != list.variables.end() && listed->second.mark == FilterMark::kOffline;
    if (listed == list.variables.end() && holds_places(variable.kind))
      xml.fail_at_line(
          variable.line,
          fmt::format(
              "{} is a {}{} and is not in {}; write there {} {}", in_quotes(variable.name), variable.type,
              variable.kind == StoredKind::kUnknown ? ", which is no type of VAL3 and may hold points," : "",
              list.source, variable.name,
              variable.kind == StoredKind::kPoint || variable.kind == StoredKind::kJoint
                  ? "offline, taught or leave"
                  : "leave"));
    if (is_offline && variable.kind != StoredKind::kPoint && variable.kind != StoredKind::kJoint)
      throw ConfigError(list.source + ':' + std::to_string(listed->second.line), "",
                        fmt::format("{} is a {}: only points and joints of six axes are filtered; write {} "
                                    "leave",
                                    in_quotes(variable.name), variable.type, variable.name));
  }
}

/// Frames that were shown to the nominal arm, with the list that says so.
TaughtFrames taught_frames(const FilterList& list) {
  TaughtFrames taught{.source = list.source};
  for (const auto& [name, listed] : list.variables)
    if (listed.mark == FilterMark::kTaught) taught.names.insert(name);
  return taught;
}

class DataFilter {
 public:
  DataFilter(const XmlText& xml, const StoredData& data, const FilterList& list, const Corrector& corrector,
             double mm_per_unit)
      : xml_(xml),
        list_(list),
        corrector_(corrector),
        mm_per_unit_(mm_per_unit),
        chains_(xml, data, mm_per_unit, taught_frames(list)) {}

  FilteredData run(const StoredData& data) {
    for (const StoredVariable& variable : data.variables) {
      result_.kinds.emplace(variable.name, variable.kind);
      const auto listed = list_.variables.find(variable.name);
      const bool is_offline = listed != list_.variables.end() && listed->second.mark == FilterMark::kOffline;
      if (is_offline) filter(variable, listed->second.tool);
      keep_places(variable, is_offline);
    }
    for (const std::string& frame : frames_)
      result_.notes.push_back(frame +
                              " is taken as it is stored: where it was touched, touch it with the "
                              "calibrated arm before its points are filtered");
    result_.text = edited(xml_.bytes(), std::move(edits_));
    return std::move(result_);
  }

 private:
  void filter(const StoredVariable& variable, const std::string& tool) {
    std::map<std::string, SixNumbers> stored;
    for (const StoredElement& element : variable.elements)
      if (element.numbers) stored.emplace(element.key, numbers_of(*element.numbers));
    const std::string digest = points_digest(stored);
    refuse_filtered_points(list_, xml_.source(), variable.name, digest);
    made_ = std::move(stored);
    filter_elements(variable, tool);
    if (std::string made = points_digest(made_); made != digest)
      result_.mark.points.push_back({.variable = variable.name, .sha256 = std::move(made)});
  }

  void filter_elements(const StoredVariable& variable, const std::string& tool) {
    double& moved_max_mm = result_.filtered_variables[variable.name];
    for (const StoredElement& element : variable.elements) {
      FilteredValue value{.variable = variable.name,
                          .key = element.key,
                          .name = shown_element(variable, element.key),
                          .line = element.line};
      if (!element.numbers)
        xml_.fail_at_line(element.line, value.name + " has no element with its numbers; write it, or mark " +
                                            variable.name + " leave");
      variable.kind == StoredKind::kJoint ? filter_joint(element, tool, value)
                                          : filter_point(variable, element, tool, value);
      if (value.status != CorrectionStatus::kRefused) moved_max_mm = std::max(moved_max_mm, value.moved_mm);
      result_.values.push_back(std::move(value));
    }
    if (variable.elements.size() < variable.size)
      result_.notes.push_back(
          fmt::format("{}: {} of {} elements have no value in the file, are 0 and stay so", variable.name,
                      variable.size - variable.elements.size(), variable.size));
  }

  Correction correction_of(OfflineTarget target, FilteredValue& value) {
    Correction correction = corrector_(target);
    value.status = correction.status;
    value.reason = correction.reason;
    if (correction.status != CorrectionStatus::kRefused) value.moved_mm = correction.moved_mm;
    return correction;
  }

  void filter_joint(const StoredElement& element, const std::string& tool, FilteredValue& value) {
    const Correction correction =
        correction_of({value.name, OfflineJoints{numbers_of(*element.numbers)}, tool}, value);
    if (correction.status == CorrectionStatus::kRefused) return;
    made_[element.key] = correction.joints_deg;
    value.inserted = append_edits(xml_, *element.numbers, kJointNames, correction.joints_deg, edits_);
  }

  void filter_point(const StoredVariable& variable, const StoredElement& element, const std::string& tool,
                    FilteredValue& value) {
    if (!element.father)
      xml_.fail_at_line(element.line, value.name + " is given in no frame; give it one, or mark " +
                                          variable.name + " leave");
    const FrameChains::Found frame = chains_.find(*element.father);
    if (!frame.unknown.empty())
      xml_.fail_at_line(element.line,
                        value.name + ": " + frame.unknown + ", or mark " + variable.name + " leave");
    if (element.father->name != "world" && !list_.variables.contains(element.father->name))
      frames_.insert(element.father->name + '[' + element.father->key + ']');
    const SixNumbers stored = numbers_of(*element.numbers);
    const Eigen::Isometry3d world_from_tool = frame.world_from_frame * pose_of_trsf(stored, mm_per_unit_);
    const Correction correction =
        correction_of({value.name, OfflinePose{world_from_tool, element.posture}, tool}, value);
    if (correction.status == CorrectionStatus::kRefused) return;
    const Eigen::Isometry3d frame_from_tool = frame.world_from_frame.inverse() * correction.world_from_tool;
    const SixNumbers made = trsf_of_pose(frame_from_tool, stored, mm_per_unit_);
    made_[element.key] = made;
    value.inserted = append_edits(xml_, *element.numbers, kTrsfNames, made, edits_);
  }

  /// What the warnings about programs compute distances from.
  void keep_places(const StoredVariable& variable, bool is_offline) {
    if (variable.kind != StoredKind::kPoint && variable.kind != StoredKind::kTrsf) return;
    for (const StoredElement& element : variable.elements) {
      if (!element.numbers) continue;
      const std::string name = variable.name + '[' + element.key + ']';
      const SixNumbers trsf = numbers_of(*element.numbers);
      if (variable.kind == StoredKind::kTrsf) {
        result_.trsfs.emplace(name, trsf);
      } else if (element.father) {
        const FrameChains::Found frame = chains_.find(*element.father);
        if (frame.unknown.empty())
          result_.points.emplace(
              name, StoredPlace{frame.world_from_frame * pose_of_trsf(trsf, mm_per_unit_), is_offline});
      }
    }
  }

  const XmlText& xml_;
  const FilterList& list_;
  const Corrector& corrector_;
  double mm_per_unit_;
  FrameChains chains_;
  FilteredData result_;
  std::vector<TextEdit> edits_;
  std::set<std::string> frames_;            // of points, of which the list says nothing
  std::map<std::string, SixNumbers> made_;  // of the variable that is filtered, by the keys of its elements
};

}  // namespace

std::size_t FilteredData::count(CorrectionStatus status) const {
  return static_cast<std::size_t>(std::ranges::count(values, status, &FilteredValue::status));
}

FilteredData filter_data(const std::string& source, std::string bytes, const FilterList& list,
                         const Corrector& corrector, double mm_per_unit) {
  const XmlText xml(source, std::move(bytes));
  const std::string original_sha256 = sha256_hex(xml.bytes());
  refuse_filtered_file(list, source, original_sha256);
  const StoredData data = read_stored_data(xml);
  compare_with_list(xml, data, list);
  FilteredData result = DataFilter(xml, data, list, corrector, mm_per_unit).run(data);
  result.mark.original_sha256 = original_sha256;
  result.mark.result_sha256 = sha256_hex(result.text);
  return result;
}

}  // namespace cell
