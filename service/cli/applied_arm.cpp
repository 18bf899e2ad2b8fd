#include "service/cli/applied_arm.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>

#include "config/arm_file.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "service/base/utc_time.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/documents/conditions_document.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/model_document.hpp"
#include "service/documents/run_document.hpp"

namespace cell {
namespace {

constexpr std::string_view kCurrentModel = "current";
/// Of a hash, to name its model: as many as touchcal models shows.
constexpr std::size_t kHashDigitsMin = 12;

bool is_meant(const ApprovalRow& row, const std::string& model) {
  if (row.kind != "approved") return false;
  if (model == kCurrentModel) return row.current;
  return row.id == model || (model.size() >= kHashDigitsMin && row.hash.starts_with(model));
}

/// The newest approval that is meant, of all that the daemon has.
ApprovalRow find_approval(const ApiClient& daemon, const std::string& model) {
  std::optional<std::string> before;
  do {
    const ApiReply reply = daemon.get("/api/v1/models" + (before ? "?before=" + *before : ""));
    if (reply.status != 200) throw ModelRefused(reply);
    const ModelsDocument page = read_reply(reply, read_models);
    const auto found =
        std::ranges::find_if(page.models, [&model](const auto& row) { return is_meant(row, model); });
    if (found != page.models.end()) return *found;
    before = page.next_before;
  } while (before);
  throw ModelRefused(
      model == kCurrentModel
          ? "--model current: no model is approved; touchcal approve RUN makes that of an accepted run the "
            "cell's"
          : fmt::format("--model {}: there is no approval with this id or hash; touchcal models lists them",
                        model));
}

/// What the daemon tells of a run. Throws std::invalid_argument where it has none of this id.
ApiReply reply_of_run(const ApiClient& daemon, const std::string& run) {
  demand_run_id(run);
  ApiReply reply = daemon.get("/api/v1/runs/" + run);
  if (reply.status == 404) throw std::invalid_argument(problem_line(reply));
  if (reply.status != 200) throw ModelRefused(reply);
  return reply;
}

/// Of a check of run `of_run`.
CheckWarmth warmth_found(const ApiClient& daemon, const std::string& check, const std::string& of_run) {
  const ApiReply run = reply_of_run(daemon, check);
  const ApiReply result = daemon.get("/api/v1/runs/" + check + "/result");
  if (result.status != 200) throw ModelRefused(result);
  auto found = warmth_of(check, read_reply(run, read_run).ended_at.value_or(""), result.body, of_run);
  if (auto* why = std::get_if<std::string>(&found)) throw ModelRefused(*why);
  return std::get<CheckWarmth>(std::move(found));
}

/// Of the robot that the run was made with, where its cell's file told it.
std::optional<std::string> serial_of_run(const ApiClient& daemon, const std::string& run) {
  const ApiReply reply = daemon.get("/api/v1/runs/" + run);
  if (reply.status != 200) throw ModelRefused(reply);
  const auto conditions = read_reply(reply, read_run).conditions;
  return conditions ? read_conditions(conditions->text).arm_serial : std::nullopt;
}

}  // namespace

ModelRefused::ModelRefused(const ApiReply& reply) : std::runtime_error(problem_line(reply)) {}

AppliedArm arm_of_file(const std::filesystem::path& file) {
  const std::string source = file.string();
  const std::string bytes = read_file_bytes(file, kConfigFileSizeMax);
  AppliedArm applied{
      .source = source, .arm = read_arm_text(source, bytes), .hash = arm_digest(source, bytes)};
  applied.serial = applied.arm.serial;
  return applied;
}

AppliedArm arm_of_model(const ApiClient& daemon, const std::string& model, const std::string& check,
                        std::chrono::system_clock::time_point now) {
  const ApprovalRow approval = find_approval(daemon, model);
  if (has_come(approval.valid_until, now))
    throw ModelRefused(fmt::format(
        "the model of run {} was valid until {}; calibrate and approve a newer run, or give --arm "
        "with the arm that touchcal export writes",
        approval.run_id, *approval.valid_until));
  if (approval.current) {  // which is refused where the cell has another arm now
    const ApiReply current = daemon.get("/api/v1/models/current");
    if (current.status != 200) throw ModelRefused(current);
  }
  const ApiReply reply = daemon.get("/api/v1/models/" + approval.id + "/arm");
  if (reply.status != 200) throw ModelRefused(reply);
  const std::string source = fmt::format("the arm of the approved model of run {}", approval.run_id);
  AppliedArm applied{.source = source,
                     .arm = read_arm_text(source, reply.body),
                     .hash = approval.hash,
                     .of_run = approval.run_id,
                     .serial = serial_of_run(daemon, approval.run_id),
                     .valid_until = approval.valid_until};
  if (!approval.current)
    applied.remark = fmt::format(
        "the model of run {} is not the cell's any more: it was taken back, or another was approved; "
        "--model current applies the one that is",
        approval.run_id);
  if (!check.empty()) {
    applied.warmth = warmth_found(daemon, check, approval.run_id);
    applied.arm = grown(applied.arm, *applied.warmth);
  }
  return applied;
}

namespace {

TouchedTool touched_tool(const std::string& from, std::string_view result_json) {
  auto found = touched_tool_of(from, result_json);
  if (auto* why = std::get_if<std::string>(&found)) throw ModelRefused(*why);
  return std::get<TouchedTool>(std::move(found));
}

TouchedTool touched_tool_of_run(const std::string& run, std::string_view result_json) try {
  return touched_tool("run " + run, result_json);
} catch (const DocumentError& error) {
  throw ModelRefused(fmt::format("the result of run {} cannot be read: {}", run, error.what()));
}

void add_touched(TouchedTool tool, AppliedArm& applied) {
  if (applied.touched_as(tool.tool))
    throw std::invalid_argument(
        fmt::format("{} is of the tool {} too; give one of the two", tool.from, tool.tool));
  applied.touched.push_back(std::move(tool));
}

}  // namespace

const TouchedTool* AppliedArm::touched_as(const std::string& tool) const {
  const auto found = std::ranges::find(touched, tool, &TouchedTool::tool);
  return found == touched.end() ? nullptr : &*found;
}

std::vector<std::string> remarks_on(const Cell& cell, const AppliedArm& applied) {
  std::vector<std::string> remarks;
  if (!applied.remark.empty()) remarks.push_back(applied.remark);
  const bool is_file = applied.of_run.empty();
  if (is_file && !applied.serial)
    remarks.push_back(
        applied.source +
        " has no serial number: nothing tells whether it is of this very robot; touchcal export "
        "writes it where the cell's file had arm_serial at the calibration");
  else if (is_file && !cell.arm_serial)
    remarks.push_back(
        fmt::format("{} is of the robot with the serial number '{}', and the cell's file names none; add "
                    "arm_serial to it",
                    applied.source, *applied.serial));
  return remarks;
}

void demand_serial_of(const Cell& cell, const AppliedArm& applied) {
  if (!applied.serial || !cell.arm_serial || *applied.serial == *cell.arm_serial) return;
  throw ModelRefused(fmt::format(
      "{} is of the robot with the serial number '{}', and the cell's file has '{}' (/arm_serial); give the "
      "cell of that robot, or the model of this one",
      applied.source, *applied.serial, *cell.arm_serial));
}

void add_touched_run(const ApiClient& daemon, const std::string& run, AppliedArm& applied) {
  const ApiReply told = reply_of_run(daemon, run);
  const ApiReply result = daemon.get("/api/v1/runs/" + run + "/result");
  if (result.status != 200) throw ModelRefused(result);
  TouchedTool tool = touched_tool_of_run(run, result.body);
  if (const auto why = why_other_calibration(tool, read_reply(told, read_run).of_run, applied.of_run))
    throw ModelRefused(*why);
  add_touched(std::move(tool), applied);
}

void add_touched_file(const std::filesystem::path& file, AppliedArm& applied) try {
  add_touched(touched_tool(file.string(), read_file_bytes(file, kConfigFileSizeMax)), applied);
} catch (const DocumentError& error) {
  throw ConfigError(file.string(), "",
                    std::string(error.what()) + "; write it again with touchcal show RUN --json");
}

}  // namespace cell
