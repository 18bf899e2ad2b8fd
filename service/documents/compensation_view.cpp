#include "service/documents/compensation_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/file_bytes.hpp"
#include "config/strict_json.hpp"
#include "service/base/digest.hpp"

namespace cell {
namespace {

using calib::CompensatedTarget;
using calib::CompensationReason;

std::string degrees(double angle_rad) {
  return fmt::format("{:.4g} deg", calib::degrees_from_radians(angle_rad));
}

/// "joint 5 would be at 141.2 deg, outside -115 to 140 deg".
std::string range_sentence(const char* who, const CompensatedTarget& target,
                           const calib::JointRanges& ranges) {
  const Eigen::Index joint = target.joint - 1;
  return fmt::format("{} joint {} at {:.6f} deg, outside its range of {:.6g} to {:.6g} deg", who,
                     target.joint, calib::degrees_from_radians(target.angle_rad),
                     calib::degrees_from_radians(ranges.lower[joint]),
                     calib::degrees_from_radians(ranges.upper[joint]));
}

std::string singular_sentence(const char* posture, const CompensatedTarget& target, double limit_rad) {
  const bool is_refused = target.status == calib::CompensationStatus::kRefused;
  return fmt::format("{} of {}: under {} a correction turns joints far{}", degrees(target.angle_rad), posture,
                     degrees(is_refused ? limit_rad : calib::kWarnedWithin * limit_rad),
                     is_refused ? "; choose another posture" : "");
}

std::optional<std::string> reason_sentence(const CompensatedTarget& target,
                                           const calib::JointRanges& ranges) {
  switch (target.reason) {
    case CompensationReason::kNone:
      return std::nullopt;
    case CompensationReason::kStraightWrist:
      return "the wrist is within " + singular_sentence("straight", target, calib::kWristMarginMinRad);
    case CompensationReason::kStretchedElbow:
      return "the elbow is within " + singular_sentence("stretched", target, calib::kElbowMarginMinRad);
    case CompensationReason::kNominalOutOfReach:
      return "out of reach: the nominal arm has no posture there in the configuration of the near joints";
    case CompensationReason::kNominalOutOfRange:
      return range_sentence("the target itself has", target, ranges);
    case CompensationReason::kOutOfReach:
      return "out of reach of the calibrated arm";
    case CompensationReason::kOutOfRange:
      return range_sentence("the correction would have", target, ranges);
    case CompensationReason::kOtherConfiguration:
      return "the correction would change the configuration of shoulder, elbow or wrist";
  }
  return std::nullopt;
}

std::string on_the_way(double share) { return fmt::format("at {:.0f} % of the way ", 100.0 * share); }

/// Why a straight line cannot be held.
std::string line_failure(const calib::LineCorrection& line, const calib::JointRanges& ranges) {
  using calib::LineReason;
  switch (line.reason) {
    case LineReason::kNone:
      break;
    case LineReason::kHalfTurn:
      return fmt::format("the tool turns by {} on it, for which there is no shortest way",
                         degrees(line.angle_rad));
    case LineReason::kOtherConfiguration:
      return "the configuration of shoulder, elbow or wrist changes on it";
    case LineReason::kOtherTurns:
      return fmt::format("it leads joint {} to {:.6f} deg, which is not where the target has it", line.joint,
                         calib::degrees_from_radians(line.angle_rad));
    case LineReason::kJointTurnsFar:
      return on_the_way(line.share) +
             fmt::format("joint {} turns by {} at once, near a posture in which the arm loses a direction",
                         line.joint, degrees(line.angle_rad));
    case LineReason::kPosture:
    case LineReason::kPoint:
      return on_the_way(line.share) + reason_sentence(line.point, ranges).value_or("");
    case LineReason::kStaysOff:
      return on_the_way(line.share) +
             fmt::format(
                 "the tool stays {:.4f} mm off, however many points there are; allow more with line_max_mm",
                 calib::mm_from_metres(line.deviation_m));
  }
  return {};
}

/// What is said of the line that ends at a target; nothing where it is held or there is none.
std::optional<std::string> line_sentence(const PathTarget& target, const calib::JointRanges& ranges) {
  if (target.line_from.empty()) return std::nullopt;
  const std::string line = "the straight line from " + target.line_from;
  if (!target.line) {
    if (!target.result.joints) return std::nullopt;
    return line + " is not judged, since its start is refused";
  }
  if (target.line->reason == calib::LineReason::kNone) return std::nullopt;
  return line + " cannot be held: " + line_failure(*target.line, ranges) +
         "; reach the target by a joint move, or split the line by a target between";
}

CompensationDocument::Target target_of(const std::string& name, const CompensatedTarget& result,
                                       const calib::JointRanges& ranges) {
  CompensationDocument::Target target{
      .name = name, .status = result.status, .reason = reason_sentence(result, ranges)};
  if (result.joints) {
    auto& joints_deg = target.joints_deg.emplace();
    for (std::size_t joint = 0; joint < joints_deg.size(); ++joint)
      joints_deg[joint] = calib::degrees_from_radians((*result.joints)[static_cast<Eigen::Index>(joint)]);
  }
  if (result.moved_m) target.moved_mm = calib::mm_from_metres(*result.moved_m);
  if (result.residual_m) target.residual_um = calib::um_from_metres(*result.residual_m);
  if (result.tip_std_m) target.tip_uncertainty_mm = calib::mm_from_metres(*result.tip_std_m);
  return target;
}

CompensationDocument::Target target_of(const PathTarget& from, const calib::JointRanges& ranges) {
  CompensationDocument::Target target = target_of(from.name, from.result, ranges);
  target.inserted = from.is_inserted;
  target.line_deviation_mm.emplace();
  if (from.line && from.line->reason == calib::LineReason::kNone)
    *target.line_deviation_mm = calib::mm_from_metres(from.line->deviation_m);
  if (auto line = line_sentence(from, ranges))
    target.reason = target.reason ? *target.reason + "; " + *line : *std::move(line);
  return target;
}

constexpr double kPartsInAMillion = 1e6;

CompensationDocument head_of(const std::string& model, const std::optional<CheckWarmth>& warmth) {
  CompensationDocument document{.model = model};
  if (warmth)
    document.warmth = {.check_run_id = warmth->check_run_id,
                       .at = warmth->at,
                       .growth_ppm = warmth->growth * kPartsInAMillion};
  return document;
}

}  // namespace

std::string arm_digest(const std::string& source, std::string_view bytes) {
  return sha256_hex(parse_strict_json(source, bytes, kConfigFileSizeMax).dump() + "\n");
}

CompensationDocument compensation_of(const Cell& cell, const std::vector<Target>& targets,
                                     const std::vector<CompensatedTarget>& results, const std::string& model,
                                     const std::optional<CheckWarmth>& warmth) {
  CompensationDocument document = head_of(model, warmth);
  document.targets.reserve(targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i)
    document.targets.push_back(target_of(targets[i].name, results.at(i), cell.arm.joint_ranges));
  return document;
}

CompensationDocument compensation_of(const Cell& cell, const std::vector<PathTarget>& path,
                                     const std::string& model, const std::optional<CheckWarmth>& warmth) {
  CompensationDocument document = head_of(model, warmth);
  document.schema = kCompensatedSchema;
  document.targets.reserve(path.size());
  for (const PathTarget& target : path) document.targets.push_back(target_of(target, cell.arm.joint_ranges));
  return document;
}

}  // namespace cell
