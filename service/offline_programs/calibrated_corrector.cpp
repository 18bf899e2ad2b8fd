#include "service/offline_programs/calibrated_corrector.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"

namespace cell {
namespace {

bool is_open(const PostureWords& words) {
  const auto open = [](auto word, auto same, auto free) { return word == same || word == free; };
  return open(words.shoulder, ShoulderWord::kSame, ShoulderWord::kFree) ||
         open(words.elbow, ElbowWord::kSame, ElbowWord::kFree) ||
         open(words.wrist, WristWord::kSame, WristWord::kFree);
}

/// The sides that the words ask for; those of `otherwise` where a word is open.
calib::ArmSides sides_of(const PostureWords& words, calib::ArmSides otherwise) {
  if (words.shoulder == ShoulderWord::kLefty) otherwise.ahead = true;
  if (words.shoulder == ShoulderWord::kRighty) otherwise.ahead = false;
  if (words.elbow == ElbowWord::kPositive) otherwise.elbow_positive = true;
  if (words.elbow == ElbowWord::kNegative) otherwise.elbow_positive = false;
  if (words.wrist == WristWord::kPositive) otherwise.wrist_positive = true;
  if (words.wrist == WristWord::kNegative) otherwise.wrist_positive = false;
  return otherwise;
}

std::string words_of_sides(const calib::ArmSides& sides) {
  return fmt::format("{}, {}, {}", sides.ahead ? "lefty" : "righty",
                     sides.elbow_positive ? "epositive" : "enegative",
                     sides.wrist_positive ? "wpositive" : "wnegative");
}

calib::JointVector radians_of(const std::array<double, 6>& joints_deg) {
  calib::JointVector joints;
  for (std::size_t i = 0; i < joints_deg.size(); ++i)
    joints[static_cast<Eigen::Index>(i)] = calib::radians_from_degrees(joints_deg[i]);
  return joints;
}

class CalibratedCorrector {
 public:
  explicit CalibratedCorrector(CalibratedArm arm)
      : arm_(std::move(arm)),
        compensation_(arm_.problem),
        reference_sides_(compensation_.nominal_sides(arm_.reference_joints)) {}

  [[nodiscard]] Correction correct(const OfflineTarget& target) const {
    const auto found = arm_.tools.find(target.tool);
    if (found == arm_.tools.end()) throw std::logic_error("a target of a tool that is not there");
    const calib::CompensationTool& tool = found->second;
    if (const auto* joints = std::get_if<OfflineJoints>(&target.place))
      return correction_of(tool, compensation_.at_joints(tool, radians_of(joints->joints_deg)));
    return at_pose(tool, std::get<OfflinePose>(target.place));
  }

 private:
  [[nodiscard]] Correction at_pose(const calib::CompensationTool& tool, const OfflinePose& pose) const {
    const calib::ArmSides wanted = sides_of(pose.posture, reference_sides_);
    // The refusal of a pose that nobody reaches in that configuration.
    calib::CompensatedTarget chosen{.reason = calib::CompensationReason::kNominalOutOfReach};
    std::vector<calib::CompensatedTarget> others;
    for (const calib::JointVector& joints : compensation_.nominal_postures(tool, pose.world_from_tool)) {
      const calib::ArmSides sides = compensation_.nominal_sides(joints);
      if (sides_of(pose.posture, sides) != sides) continue;  // not what the words ask for
      const calib::CompensatedTarget result = compensation_.at_pose(tool, pose.world_from_tool, joints);
      if (sides == wanted)
        chosen = result;
      else
        others.push_back(result);
    }
    Correction correction = correction_of(tool, chosen);
    if (is_open(pose.posture) && correction.status == CorrectionStatus::kOk)
      warn_of_others(tool, others, wanted, correction);
    return correction;
  }

  void warn_of_others(const calib::CompensationTool& tool,
                      const std::vector<calib::CompensatedTarget>& others, const calib::ArmSides& taken,
                      Correction& correction) const {
    double apart_m = 0.0;
    for (const calib::CompensatedTarget& other : others) {
      if (!other.joints) continue;
      const Eigen::Isometry3d there = compensation_.nominal_world_from_tool(tool, *other.joints);
      apart_m = std::max(apart_m, (there.translation() - correction.world_from_tool.translation()).norm());
    }
    if (calib::mm_from_metres(apart_m) <= kOpenConfigurationMm) return;
    correction.status = CorrectionStatus::kWarned;
    correction.reason = fmt::format(
        "its configuration is open and was taken as {}; in another one the point would be up to {:.3f} mm "
        "elsewhere: write shoulder, elbow and wrist",
        words_of_sides(taken), calib::mm_from_metres(apart_m));
  }

  [[nodiscard]] Correction correction_of(const calib::CompensationTool& tool,
                                         const calib::CompensatedTarget& result) const {
    Correction correction;
    if (result.reason != calib::CompensationReason::kNone) correction.reason = arm_.reason_of(result);
    if (!result.joints) return correction;
    correction.status =
        result.status == calib::CompensationStatus::kOk ? CorrectionStatus::kOk : CorrectionStatus::kWarned;
    for (std::size_t i = 0; i < correction.joints_deg.size(); ++i)
      correction.joints_deg[i] = calib::degrees_from_radians((*result.joints)[static_cast<Eigen::Index>(i)]);
    correction.world_from_tool = compensation_.nominal_world_from_tool(tool, *result.joints);
    correction.moved_mm = calib::mm_from_metres(result.moved_m.value_or(0.0));
    return correction;
  }

  CalibratedArm arm_;
  calib::Compensation compensation_;
  calib::ArmSides reference_sides_;
};

}  // namespace

Corrector calibrated_corrector(CalibratedArm arm) {
  std::map<std::string, std::shared_ptr<const CalibratedCorrector>, std::less<>> own;
  for (const auto& [tool, model] : arm.arms_by_tool) {
    CalibratedArm with_tool = arm;
    with_tool.problem.calibrated = model;
    own.emplace(tool, std::make_shared<const CalibratedCorrector>(std::move(with_tool)));
  }
  const auto others = std::make_shared<const CalibratedCorrector>(std::move(arm));
  return [own, others](const OfflineTarget& target) {
    const auto found = own.find(target.tool);
    return (found == own.end() ? others : found->second)->correct(target);
  };
}

void demand_tools(const FilterList& list, const std::vector<std::string>& tools) {
  for (const auto& [name, listed] : list.variables) {
    if (listed.mark != FilterMark::kOffline) continue;
    if (!listed.tool.empty() && std::ranges::find(tools, listed.tool) != tools.end()) continue;
    throw ConfigError(
        fmt::format("{}:{}", list.source, listed.line), "",
        fmt::format("{} {}; write one of {} behind offline", in_quotes(name),
                    listed.tool.empty() ? "names no tool"
                                        : "has the tool " + in_quotes(listed.tool) + ", which is not there",
                    fmt::join(tools, ", ")));
  }
}

}  // namespace cell
