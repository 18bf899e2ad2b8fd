#include <spdlog/fmt/fmt.h>

#include "config/arm_file.hpp"
#include "config/config_error.hpp"
#include "config/targets_file.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/run/compensated_targets.hpp"

namespace cell {
namespace {

constexpr std::int64_t kArmRunMax = std::int64_t{1} << 53;

HttpResponse no_arm(std::string detail) {
  return to_response({.status = 409, .kind = ProblemKind::kNoResult, .detail = std::move(detail)});
}

/// The run whose arm is applied: the one that the query names, else the newest accepted one.
std::optional<std::int64_t> run_to_apply(const Call& call) {
  if (const auto given = call.number("run")) return given;
  const auto accepted = call.reads.store().last_accepted();
  return accepted ? std::optional(accepted->id) : std::nullopt;
}

HttpResponse compensate_for(const Call& call, std::int64_t run, const std::string& arm_json) {
  const Cell& cell = call.reads.cell();
  const std::string source = fmt::format("the arm of run {}", run);
  Arm arm;
  try {
    arm = arm_from_json(source, arm_json);
    demand_arm_of(cell, arm, source);
  } catch (const ConfigError& error) {
    return no_arm(error.what());
  }
  try {
    const TargetsFile file = targets_from_json("request body", call.request.body, kTargetsBytesMax);
    const calib::CompensationTool tool = tool_named(cell, arm, file.tool, "request body", "/tool");
    return {.body =
                document_text(compensation_of(cell, file.targets, compensated(cell, arm, tool, file.targets),
                                              arm_digest(source, arm_json)))};
  } catch (const ConfigError& error) {
    return to_response({.kind = ProblemKind::kBody, .detail = error.what(), .pointer = error.pointer()});
  }
}

HttpResponse post_compensate(const Call& call) {
  const auto run = run_to_apply(call);
  if (!run) return no_arm("no run was accepted yet; name one with ?run=ID, or calibrate");
  if (!call.reads.store().run(*run)) {
    return to_response({.status = 422,
                        .kind = ProblemKind::kNotFound,
                        .detail = fmt::format("there is no run {}; GET /api/v1/runs lists them", *run),
                        .parameter = "run"});
  }
  const auto arm_json = call.reads.store().arm_json(*run);
  if (!arm_json) return no_arm(fmt::format("run {} has no calibrated arm; name another with ?run=ID", *run));
  return compensate_for(call, *run, *arm_json);
}

}  // namespace

std::vector<Route> compensation_routes() {
  return {
      {.method = "POST",
       .path = "/api/v1/compensate",
       .summary = "Corrects targets for a calibrated arm; changes nothing",
       .access = Access::kOperate,
       .handle = post_compensate,
       .answers = {{.schema = "Compensated"}},
       .query = {{"run", 1, kArmRunMax, "the run whose arm is applied; the newest accepted one by default"}},
       .body_schema = "Targets",
       .body_bytes_max = kTargetsBytesMax,
       .dispatch = DispatchMode::kWorker}};
}

}  // namespace cell
