#include "service/run/straight_line_targets.hpp"

#include <spdlog/fmt/fmt.h>

#include <set>

#include "config/config_error.hpp"
#include "service/run/compensated_targets.hpp"

namespace cell {
namespace {

using calib::CompensationStatus;

/// The pose of the tool that a target means.
Eigen::Isometry3d meant_pose(const calib::Compensation& compensation, const calib::CompensationTool& tool,
                             const Target& target) {
  if (const auto* pose = std::get_if<PoseTarget>(&target.wanted)) return pose->world_from_tool;
  return compensation.nominal_world_from_tool(tool, std::get<calib::JointVector>(target.wanted));
}

/// What is told of a refused target: how far it would have moved, and nothing to be commanded.
calib::CompensatedTarget refused_for_its_line(const calib::CompensatedTarget& target) {
  return {.status = CompensationStatus::kRefused, .moved_m = target.moved_m};
}

class PathWriter {
 public:
  PathWriter(const TargetsFile& file, std::string source) : file_(file), source_(std::move(source)) {
    for (const Target& target : file.targets) names_.insert(target.name);
    path_.reserve(file.targets.size());
  }

  /// The points of a line, before its end.
  void append_points(std::size_t target, const std::vector<calib::CompensatedTarget>& points) {
    const std::size_t left = file_.targets.size() - target;
    if (path_.size() + points.size() + left > kTargetCountMax)
      refuse(
          target, "/move",
          fmt::format("needs points with which there are more than {} targets and points; split the file, or "
                      "allow the lines more with line_max_mm",
                      kTargetCountMax));
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::string name = fmt::format("{}.{}", file_.targets[target].name, i + 1);
      if (name.size() > kTargetNameSizeMax)
        refuse(target, "/name",
               fmt::format("is too long for the points of its straight line: {} would have {} bytes; give a "
                           "name for which that is at most {}",
                           in_quotes(name), name.size(), kTargetNameSizeMax));
      if (names_.contains(name))
        refuse(target, "/name",
               fmt::format("needs a point {} on its straight line, but a target has that name; rename one of "
                           "the two",
                           in_quotes(name)));
      path_.push_back({.name = std::move(name), .result = points[i], .is_inserted = true});
    }
  }
  void append(PathTarget target) { path_.push_back(std::move(target)); }
  std::vector<PathTarget> path() && { return std::move(path_); }

 private:
  [[noreturn]] void refuse(std::size_t target, const char* key, const std::string& what) const {
    throw ConfigError(source_, fmt::format("/targets/{}{}", target, key), what);
  }

  const TargetsFile& file_;
  std::string source_;
  std::set<std::string> names_;  // of the file's targets
  std::vector<PathTarget> path_;
};

}  // namespace

double line_max_m(const TargetsFile& file, const std::optional<double>& given) {
  return given.value_or(file.line_max_m.value_or(calib::kLineDeviationMaxMetres));
}

std::vector<PathTarget> compensated_path(const Cell& cell, const Arm& arm,
                                         const calib::CompensationTool& tool, const TargetsFile& file,
                                         double deviation_max_m, const std::string& source) {
  const calib::Compensation compensation = compensation_in(cell, arm);
  const std::vector<calib::CompensatedTarget> ends = compensated(compensation, tool, file.targets);
  PathWriter writer(file, source);
  std::optional<calib::JointVector> start;  // of the target before, when it is not refused
  for (std::size_t i = 0; i < ends.size(); ++i) {
    PathTarget end{.name = file.targets[i].name, .result = ends[i]};
    if (file.targets[i].move == TargetMove::kLine) {
      end.line_from = file.targets[i - 1].name;
      if (start && ends[i].joints) {
        end.line =
            calib::corrected_line(compensation, tool,
                                  {.world_from_start = meant_pose(compensation, tool, file.targets[i - 1]),
                                   .world_from_end = meant_pose(compensation, tool, file.targets[i]),
                                   .start_joints = *start,
                                   .end_joints = *ends[i].joints},
                                  deviation_max_m);
        writer.append_points(i, end.line->points);
        end.line->points = {};
        if (end.line->reason != calib::LineReason::kNone) end.result = refused_for_its_line(end.result);
      } else if (ends[i].joints) {
        end.result.status = CompensationStatus::kWarned;
      }
    }
    start = end.result.joints;
    writer.append(std::move(end));
  }
  return std::move(writer).path();
}

}  // namespace cell
