#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <variant>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"
#include "service/base/utc_time.hpp"
#include "service/documents/model_document.hpp"
#include "service/http/routes/internal/start_body.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "service/store/model_store.hpp"

namespace cell {
namespace {

constexpr int kModelsPageDefault = 100;
constexpr int kModelsPageMax = 500;
constexpr std::int64_t kModelIdMax = std::int64_t{1} << 53;
constexpr int kValidDaysMax = 36'500;
constexpr std::string_view kOperatorKey = "operator";
constexpr std::string_view kValidDaysKey = "valid_days";
constexpr std::string_view kToKey = "to";
constexpr std::string_view kHashKey = "hash";
constexpr std::size_t kToBytesMax = 200;
/// Of a hash, to name its model.
constexpr std::size_t kNamedHashMin = 12;

/// What a body may hold besides the operator.
enum class ApprovalBody { kApproval, kRollback, kApplication };

std::string known_keys(ApprovalBody kind) {
  switch (kind) {
    case ApprovalBody::kApproval:
      return "operator, valid_days";
    case ApprovalBody::kRollback:
      return "operator";
    case ApprovalBody::kApplication:
      return "to, hash, operator";
  }
  return {};
}

HttpResponse not_approved(ProblemKind kind, std::string detail) {
  return to_response({.status = 409, .kind = kind, .detail = std::move(detail)});
}

Problem wrong_approval(std::string_view key, std::string detail) {
  return {.kind = ProblemKind::kBody, .detail = std::move(detail), .pointer = pointer_step(std::string(key))};
}

std::variant<ApprovalRequest, Problem> approval_in(const nlohmann::json& body, ApprovalBody kind) {
  if (!body.is_object())
    return Problem{.kind = ProblemKind::kBody, .detail = "an object is required", .pointer = ""};
  const bool is_application = kind == ApprovalBody::kApplication;
  ApprovalRequest request;
  for (const auto& [key, value] : body.items()) {
    if (key == kOperatorKey) {
      if (!value.is_string() || !is_operator_name(value.get_ref<const std::string&>()))
        return wrong_approval(key, operator_name_is());
      request.operator_name = value.get<std::string>();
    } else if (is_application && key == kToKey) {
      if (!value.is_string() || !is_line(value.get_ref<const std::string&>(), kToBytesMax))
        return wrong_approval(
            key, fmt::format("a text of at most {} bytes without control characters is required: what uses "
                             "the model, \"pick.dtx on the robot\"",
                             kToBytesMax));
      request.to = value.get<std::string>();
    } else if (is_application && key == kHashKey) {
      if (!value.is_string() || value.get_ref<const std::string&>().size() < kNamedHashMin)
        return wrong_approval(
            key, "the hash of a model that was approved is required, or its first twelve digits");
      request.hash = value.get<std::string>();
    } else if (kind == ApprovalBody::kApproval && key == kValidDaysKey) {
      if (!value.is_number_integer() || value < 1 || value > kValidDaysMax)
        return wrong_approval(key,
                              fmt::format("a whole number of days from 1 to {} is required", kValidDaysMax));
      request.valid_days = value.get<int>();
    } else {
      return wrong_approval(key, fmt::format("unknown key; known are {}", known_keys(kind)));
    }
  }
  if (is_application && !request.to)
    return wrong_approval(kToKey, "is missing: what uses the model, \"pick.dtx on the robot\"");
  return request;
}

/// The body of an approval or a rollback may be left out: it only names who gives it, and for how long.
std::variant<ApprovalRequest, Problem> read_approval(const Call& call, ApprovalBody kind) {
  const std::string& body = call.request.body;
  const std::string signed_in = call.start ? signed_in_of(*call.start) : std::string();
  try {
    std::variant<ApprovalRequest, Problem> read = ApprovalRequest{};
    if (!body.empty() || kind == ApprovalBody::kApplication)
      read = approval_in(
          body.empty() ? nlohmann::json::object() : parse_strict_json("request body", body, kBodyBytesMax),
          kind);
    auto* request = std::get_if<ApprovalRequest>(&read);
    if (!request) return read;
    auto operator_name = read_operator_of(signed_in, request->operator_name);
    if (auto* problem = std::get_if<Problem>(&operator_name)) return std::move(*problem);
    request->operator_name = std::get<0>(std::move(operator_name));
    return read;
  } catch (const ConfigError& error) {
    return Problem{.kind = ProblemKind::kBody, .detail = error.what(), .pointer = error.pointer()};
  }
}

/// Nothing when the model is of the cell's arm.
std::optional<HttpResponse> refuse_other_arm(const Call& call, const ModelDocument& model) {
  const auto why = why_other_arm(model, call.reads.cell());
  if (!why) return std::nullopt;
  return not_approved(ProblemKind::kOtherArm, *why);
}

/// The document of an approval, unless the cell has another arm now.
HttpResponse tell_model(const Call& call, const ModelStore& models, const Approval& approval) {
  std::string document = models.document(approval.id).value();
  if (auto refused = refuse_other_arm(call, read_model(document))) return *std::move(refused);
  return json_response(200, std::move(document));
}

HttpResponse get_models(const Call& call) {
  const auto limit = static_cast<std::size_t>(call.number("limit").value_or(kModelsPageDefault));
  const auto history = ModelStore(call.reads.store().database()).history();
  return json_response(200, document_text(models_page(history, limit, call.number("before"))));
}

HttpResponse no_model() {
  return not_approved(ProblemKind::kNoModel,
                      "no model is approved; touchcal approve RUN makes that of an accepted run the cell's");
}

HttpResponse get_current_model(const Call& call) {
  const ModelStore models(call.reads.store().database());
  const auto standing = standing_approvals(models.history());
  return standing.empty() ? no_model() : tell_model(call, models, standing.back());
}

HttpResponse get_model_arm(const Call& call) {
  const auto id = call.run_id();
  const auto arm_json = id ? ModelStore(call.reads.store().database()).arm_json(*id) : std::nullopt;
  if (!arm_json)
    return not_found(fmt::format("there is no approval '{}'; GET /api/v1/models lists them", call.id));
  return json_response(200, *arm_json);
}

/// Why the result of a run cannot become a model of this cell; nothing when it can.
std::optional<std::string> why_no_model(const StoredRun& run, const std::string& cell) {
  constexpr std::string_view kOnly = "only a run that is complete and accepted can be approved";
  if (run.origin && run.origin->cell != cell)
    return fmt::format("run {} is of the cell '{}', and this is the cell '{}'; approve it there", run.id,
                       run.origin->cell, cell);
  if (run.kind != RunKind::kCalibration)
    return fmt::format("run {} is a {}, which has no model; approve the calibration that it is of", run.id,
                       run_kind_name(run.kind));
  if (run.outcome == RunOutcome::kRunning) return fmt::format("run {} is not over; {}", run.id, kOnly);
  if (run.outcome == RunOutcome::kComplete && run.verdict == Verdict::kAccepted) return std::nullopt;
  return fmt::format("the outcome of run {} is '{}' and its verdict '{}'; {}", run.id,
                     run_outcome_name(run.outcome), verdict_name(run.verdict), kOnly);
}

/// The newest proof that the calibration passed; nothing where there is none.
std::optional<std::string> newest_proof_of(const RunStore& store, std::int64_t run_id) {
  std::optional<std::string> newest;
  for (const StoredRun& proof : store.complete_runs_of(run_id, RunKind::kProof))
    newest = proof.verdict == Verdict::kAccepted ? std::optional(std::to_string(proof.id)) : std::nullopt;
  return newest;
}

HttpResponse approve(const Call& call, const StoredRun& run, const ApprovalRequest& request) {
  if (const auto why = why_no_model(run, call.reads.cell().name))
    return not_approved(ProblemKind::kNotApprovable, *why);
  const RunStore& store = call.reads.store();
  const auto arm = store.arm_json(run.id), result = store.result_json(run.id);
  if (!arm || !result)
    return not_approved(ProblemKind::kNotApprovable,
                        fmt::format("no calibrated arm was stored when run {} ended, and none is computed "
                                    "again; calibrate once more and approve that run",
                                    run.id));
  ModelDocument model = model_of(run, store.touches(run.id), *arm, *result);
  if (auto refused = refuse_other_arm(call, model)) return *std::move(refused);
  const auto now = call.reads.now();
  model.proof_run_id = newest_proof_of(store, run.id);
  model.approved_by = request.operator_name;
  model.approved_at = format_utc(now);
  if (request.valid_days) model.valid_until = format_utc(now + std::chrono::days(*request.valid_days));
  const Approval current = call.services.models.approve({.run_id = run.id,
                                                         .at = model.approved_at,
                                                         .operator_name = model.approved_by,
                                                         .hash = model.hash,
                                                         .valid_until = model.valid_until,
                                                         .document = document_text(model),
                                                         .arm_json = *arm,
                                                         .check_every = call.reads.cell().check_every});
  return tell_model(call, call.services.models, current);
}

HttpResponse post_approve(const Call& call) {
  const auto request = read_approval(call, ApprovalBody::kApproval);
  if (const auto* problem = std::get_if<Problem>(&request)) return to_response(*problem);
  const auto id = call.run_id();
  const auto run = id ? call.reads.store().run(*id) : std::nullopt;
  if (!run) return not_found(fmt::format("there is no run '{}'; GET /api/v1/runs lists them", call.id));
  return approve(call, *run, std::get<ApprovalRequest>(request));
}

HttpResponse post_rollback(const Call& call) {
  const auto request = read_approval(call, ApprovalBody::kRollback);
  if (const auto* problem = std::get_if<Problem>(&request)) return to_response(*problem);
  ModelStore& models = call.services.models;
  const auto standing = standing_approvals(models.history());
  if (standing.empty()) return no_model();
  if (standing.size() == 1)
    return not_approved(
        ProblemKind::kNoModel,
        fmt::format("there is no model before that of run {}; approve another run in its place",
                    standing.back().run_id));
  const Approval& before = standing[standing.size() - 2];
  if (auto refused = refuse_other_arm(call, read_model(models.document(before.id).value())))
    return *std::move(refused);
  return tell_model(
      call, models,
      models.roll_back(format_utc(call.reads.now()), std::get<ApprovalRequest>(request).operator_name));
}

/// The newest approval of the model of that hash; without one the approval by which the cell has its model.
std::optional<Approval> applied_approval(const std::vector<Approval>& history,
                                         const std::optional<std::string>& hash) {
  const std::vector<Approval> standing = standing_approvals(history);
  if (!hash) return standing.empty() ? std::nullopt : std::optional(standing.back());
  const auto named = std::find_if(history.rbegin(), history.rend(), [&](const Approval& row) {
    return row.kind == ApprovalKind::kApproved && hash->size() >= kNamedHashMin &&
           row.hash.starts_with(*hash);
  });
  return named == history.rend() ? std::nullopt : std::optional(*named);
}

HttpResponse post_applied(const Call& call) {
  const auto read = read_approval(call, ApprovalBody::kApplication);
  if (const auto* problem = std::get_if<Problem>(&read)) return to_response(*problem);
  const auto& request = std::get<ApprovalRequest>(read);
  ModelStore& models = call.services.models;
  const auto approval = applied_approval(models.history(), request.hash);
  if (!approval)
    return request.hash ? not_approved(ProblemKind::kNoModel,
                                       fmt::format("no approval has the hash '{}'; GET /api/v1/models lists "
                                                   "them",
                                                   *request.hash))
                        : no_model();
  if (auto refused = refuse_other_arm(call, read_model(models.document(approval->id).value())))
    return *std::move(refused);
  models.note_applied({.run_id = approval->run_id,
                       .hash = approval->hash,
                       .to = *request.to,
                       .at = format_utc(call.reads.now()),
                       .operator_name = request.operator_name});
  return json_response(200, document_text(models_page(models.history(), kModelsPageDefault, {})));
}

}  // namespace

std::vector<Route> model_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/models",
       .summary = "The approvals of models, the rollbacks and what uses a model, newest first, in pages",
       .handle = get_models,
       .answers = {{.schema = "Models"}},
       .query = {{"limit", 1, kModelsPageMax, "rows on a page"},
                 {"before", 0, kModelIdMax, "only rows before this id: next_before of the page before"}},
       .dispatch = DispatchMode::kStored},
      {.method = "GET",
       .path = "/api/v1/models/current",
       .summary =
           "The model that a person approved for this cell; 409 when there is none, or for another arm",
       .handle = get_current_model,
       .answers = {{.schema = "Model"}},
       .dispatch = DispatchMode::kStored},
      {.method = "GET",
       .path = "/api/v1/models/{id}/arm",
       .summary = "The calibrated arm of an approval, as stored when the run ended; 404 for a rollback's row",
       .handle = get_model_arm,
       .answers = {{.schema = "Arm"}},
       .dispatch = DispatchMode::kStored},
      {.method = "POST",
       .path = "/api/v1/runs/{id}/approve",
       .summary = "Makes the model of a run that is complete and accepted the cell's; where it is already, "
                  "changes nothing",
       .access = Access::kEngineer,
       .handle = post_approve,
       .answers = {{.schema = "Model"}},
       .body_schema = "ApprovalRequest",
       .dispatch = DispatchMode::kWritten,
       .names_operator = true},
      {.method = "POST",
       .path = "/api/v1/models/rollback",
       .summary = "Takes the current model back; the one before is the cell's again",
       .access = Access::kEngineer,
       .handle = post_rollback,
       .answers = {{.schema = "Model"}},
       .body_schema = "RollbackRequest",
       .dispatch = DispatchMode::kWritten,
       .names_operator = true},
      {.method = "POST",
       .path = "/api/v1/models/applied",
       .summary = "Notes that what a model corrects is in use at the robot, and tells the plant; moves "
                  "nothing and changes no model",
       .access = Access::kEngineer,
       .handle = post_applied,
       .answers = {{.schema = "Models"}},
       .body_schema = "ApplicationRequest",
       .dispatch = DispatchMode::kWritten,
       .names_operator = true},
  };
}

}  // namespace cell
