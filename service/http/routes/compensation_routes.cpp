#include <spdlog/fmt/fmt.h>

#include <variant>

#include "config/arm_file.hpp"
#include "config/config_error.hpp"
#include "config/targets_file.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/model_document.hpp"
#include "service/documents/touched_tool.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/run/compensated_targets.hpp"
#include "service/run/straight_line_targets.hpp"
#include "service/store/model_store.hpp"

namespace cell {
namespace {

constexpr const char* kTargetsBody = "request body";
constexpr std::int64_t kArmRunMax = std::int64_t{1} << 53;

HttpResponse no_arm(std::string detail) {
  return to_response({.status = 409, .kind = ProblemKind::kNoResult, .detail = std::move(detail)});
}

/// The calibrated arm that is applied.
struct ArmToApply {
  std::string source;
  std::string json;
  std::string hash;  // of the model, or of the arm
  std::int64_t run = 0;
  std::optional<CheckWarmth> warmth = {};
  std::optional<TouchedTool> touched = {};
};
using ChosenArm = std::variant<ArmToApply, HttpResponse>;

ChosenArm arm_of_run(const Call& call, std::int64_t run) {
  if (!call.reads.store().run(run)) {
    return to_response({.status = 422,
                        .kind = ProblemKind::kNotFound,
                        .detail = fmt::format("there is no run {}; GET /api/v1/runs lists them", run),
                        .parameter = "run"});
  }
  auto arm_json = call.reads.store().arm_json(run);
  if (!arm_json) return no_arm(fmt::format("run {} has no calibrated arm; name another with ?run=ID", run));
  const std::string source = fmt::format("the arm of run {}", run);
  std::string hash = arm_digest(source, *arm_json);
  return ArmToApply{source, *std::move(arm_json), std::move(hash), run};
}

/// `current`: the cell's model.
ChosenArm arm_of_model(const Call& call, const ModelStore& models, const Approval& current) {
  if (has_come(current.valid_until, call.reads.now()))
    return no_arm(
        fmt::format("the model of run {} was valid until {}; calibrate and approve a newer run, or name "
                    "a run with ?run=ID",
                    current.run_id, *current.valid_until));
  if (const auto why = why_other_arm(read_model(models.document(current.id).value()), call.reads.cell()))
    return no_arm(*why);
  return ArmToApply{fmt::format("the arm of the approved model of run {}", current.run_id),
                    models.arm_json(current.id).value(), current.hash, current.run_id};
}

/// That of the run which the query names, else the approved model's, else that of the newest accepted run.
ChosenArm arm_to_apply(const Call& call) {
  if (const auto given = call.number("run")) return arm_of_run(call, *given);
  const ModelStore models(call.reads.store().database());
  const auto standing = standing_approvals(models.history());
  if (!standing.empty()) return arm_of_model(call, models, standing.back());
  if (const auto accepted = call.reads.store().last_accepted()) return arm_of_run(call, accepted->id);
  return no_arm("no run was accepted yet; name one with ?run=ID, or calibrate");
}

/// The growth that a check found; nothing when it counts.
std::optional<HttpResponse> add_warmth(const Call& call, std::int64_t check, ArmToApply& applied) {
  const RunStore& store = call.reads.store();
  const auto run = store.run(check);
  const auto result = run ? store.result_json(check) : std::nullopt;
  if (!result || !run->ended_at)
    return no_arm(fmt::format("run {} is no check that came to its end; GET /api/v1/runs lists them", check));
  auto found = warmth_of(std::to_string(check), *run->ended_at, *result, std::to_string(applied.run));
  if (auto* why = std::get_if<std::string>(&found)) return no_arm(std::move(*why));
  applied.warmth = std::get<CheckWarmth>(std::move(found));
  return std::nullopt;
}

/// The tool as a run found it; nothing when it counts.
std::optional<HttpResponse> add_tool(const Call& call, std::int64_t tool_run, const std::string& tool,
                                     ArmToApply& applied) try {
  const auto run = call.reads.store().run(tool_run);
  const auto result = run ? call.reads.store().result_json(tool_run) : std::nullopt;
  if (!result) return no_arm(fmt::format("run {} has no result; GET /api/v1/runs lists the runs", tool_run));
  auto found = touched_tool_of(fmt::format("run {}", tool_run), *result);
  if (auto* why = std::get_if<std::string>(&found)) return no_arm(std::move(*why));
  auto& touched = std::get<TouchedTool>(found);
  const auto of_run = run->of_run ? std::optional(std::to_string(*run->of_run)) : std::nullopt;
  if (auto why = why_other_calibration(touched, of_run, std::to_string(applied.run)))
    return no_arm(*std::move(why));
  demand_tool_of(call.reads.cell(), touched);
  if (touched.tool != tool)
    return no_arm(fmt::format("run {} touched the tool {}, and the targets are of {}; leave tool_run out",
                              tool_run, touched.tool, tool));
  applied.touched = std::move(touched);
  return std::nullopt;
} catch (const ConfigError& error) {
  return no_arm(error.what());
} catch (const DocumentError& error) {
  return no_arm(fmt::format("the result of run {} cannot be read: {}", tool_run, error.what()));
}

HttpResponse wrong_body(const ConfigError& error) {
  return to_response({.kind = ProblemKind::kBody, .detail = error.what(), .pointer = error.pointer()});
}

HttpResponse compensate_for(const Call& call, const TargetsFile& file, const ArmToApply& applied) {
  const Cell& cell = call.reads.cell();
  Arm arm;
  try {
    arm = read_arm_text(applied.source, applied.json);
    demand_arm_of(cell, arm, applied.source);
    demand_serial_of(cell, arm, applied.source);
    if (applied.warmth) arm = grown(arm, *applied.warmth);
  } catch (const ConfigError& error) {
    return no_arm(error.what());
  }
  try {
    calib::CompensationTool tool = tool_named(cell, arm, file.tool, kTargetsBody, "/tool");
    if (applied.touched) {
      tool = as_touched(tool, *applied.touched);
      arm.model = with_tool(arm.model, *applied.touched);
    }
    CompensationDocument document =
        file.may_have_lines()
            ? compensation_of(
                  cell, compensated_path(cell, arm, tool, file, line_max_m(file, std::nullopt), kTargetsBody),
                  applied.hash, applied.warmth)
            : compensation_of(cell, file.targets, compensated(cell, arm, tool, file.targets), applied.hash,
                              applied.warmth);
    if (applied.touched) document.touched = told_of(*applied.touched);
    return {.body = document_text(document)};
  } catch (const ConfigError& error) {
    return wrong_body(error);
  }
}

HttpResponse post_compensate(const Call& call) {
  TargetsFile file;
  try {
    file =
        targets_from_json(kTargetsBody, call.request.body, kTargetsBytesMax, call.reads.cell().target_frames);
  } catch (const ConfigError& error) {
    return wrong_body(error);
  }
  auto chosen = arm_to_apply(call);
  if (auto* refused = std::get_if<HttpResponse>(&chosen)) return std::move(*refused);
  ArmToApply& applied = std::get<ArmToApply>(chosen);
  if (const auto check = call.number("check")) {
    if (auto refused = add_warmth(call, *check, applied)) return *std::move(refused);
  }
  if (const auto tool_run = call.number("tool_run")) {
    if (auto refused = add_tool(call, *tool_run, file.tool, applied)) return *std::move(refused);
  }
  return compensate_for(call, file, applied);
}

}  // namespace

std::vector<Route> compensation_routes() {
  return {{.method = "POST",
           .path = "/api/v1/compensate",
           .summary = "Corrects targets for a calibrated arm; changes nothing",
           .access = Access::kOperate,
           .handle = post_compensate,
           .answers = {{.schema = "Compensated"}},
           .query = {{"run", 1, kArmRunMax,
                      "the run whose arm is applied; by default the approved model's, without one the newest "
                      "accepted"},
                     {"check", 1, kArmRunMax,
                      "a check of that calibration: the growth of the arm that it found is applied too"},
                     {"tool_run", 1, kArmRunMax,
                      "a run of the kind tool on that arm: the tip of the tool is where it was touched"}},
           .body_schema = "Targets",
           .body_bytes_max = kTargetsBytesMax,
           .dispatch = DispatchMode::kWorker}};
}

}  // namespace cell
