#include <spdlog/fmt/fmt.h>

#include <string>

#include "service/base/terminal_text.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/documents/model_document.hpp"

namespace cell {
namespace {

/// Of a hash, in a table; the whole one is in the document and in what is told of the current model.
constexpr std::size_t kShownOfHash = 12;

std::string mm_text(std::optional<double> value) {
  return value ? fmt::format("{:.3f} mm", *value) : std::string("not known");
}

std::string model_text(const ModelDocument& model) {
  const TipDocument& tip = model.tip_uncertainty.value;
  std::string lines;
  const auto add = [&lines](std::string_view name, const std::string& value) {
    lines += fmt::format("  {:<12}{}\n", name, value);
  };
  add("hash", model.hash);
  add("arm", model.arm + (model.arm_serial ? ", serial number " + *model.arm_serial
                                           : std::string(", serial number not known")));
  add("approved", model.approved_at + " by " + model.approved_by.value_or("nobody who was named"));
  add("valid until", model.valid_until.value_or("no end was set"));
  add("proof", model.proof_run_id ? "run " + *model.proof_run_id : std::string("not proved"));
  add("warmth", model.arm_moving_min
                    ? fmt::format("the arm had moved for {} min before the run", *model.arm_moving_min)
                    : std::string("not known"));
  add("tip, k = " + fmt::format("{:g}", tip.expanded.k),
      fmt::format("{} rms, {} at worst in the workspace box, in the block's frame",
                  mm_text(tip.expanded.box_rms_mm), mm_text(tip.expanded.box_max_mm)));
  return lines;
}

std::string table_of(const ModelsDocument& page) {
  constexpr auto kLine = "{:<6}{:<13}{:<6}{:<26}{:<26}{:<14}{:<9}{}{}\n";
  std::string lines = fmt::format(kLine, "id", "what", "run", "at", "valid until", "hash", "", "by", "");
  for (const ApprovalRow& row : page.models) {
    lines += fmt::format(kLine, row.id, row.kind == "rolled_back" ? "rolled back" : row.kind, row.run_id,
                         row.at, row.valid_until.value_or("-"), row.hash.substr(0, kShownOfHash),
                         row.current ? "current" : "", row.by.value_or("-"),
                         row.applied_to ? ": " + *row.applied_to : std::string());
  }
  if (page.next_before) lines += fmt::format("older ones: GET /api/v1/models?before={}\n", *page.next_before);
  return lines;
}

ExitCode tell_current(const ApiReply& reply, bool json) {
  if (reply.status != 200) return print_problem(reply, json);
  if (json) {
    fmt::print("{}\n", reply.body);
    return kExitDone;
  }
  const ModelDocument model = read_reply(reply, read_model);
  fmt::print("the model of run {} is the cell's\n{}", model.run_id, model_text(model));
  return kExitDone;
}

std::optional<std::string> if_given(const std::string& name) {
  return name.empty() ? std::nullopt : std::optional(name);
}

}  // namespace

ExitCode approve_command(const ApiClient& daemon, const ApproveArguments& arguments, bool json) {
  demand_run_id(arguments.run_id);
  const ApprovalRequest request{.operator_name = if_given(arguments.operator_name),
                                .valid_days = arguments.valid_days,
                                .to = {},
                                .hash = {}};
  const ApiReply reply = daemon.post("/api/v1/runs/" + arguments.run_id + "/approve", document_text(request));
  const ExitCode told = tell_current(reply, json);
  if (told == kExitDone && !json && !read_reply(reply, read_model).proof_run_id)
    fmt::print(stderr,
               "the model is not proved: on the lifted block touchcal prove shows whether the arm is right "
               "elsewhere too; a model names the proof that was passed before it was approved\n");
  return told;
}

ExitCode rollback_command(const ApiClient& daemon, const std::string& operator_name, bool json) {
  const ApprovalRequest request{
      .operator_name = if_given(operator_name), .valid_days = {}, .to = {}, .hash = {}};
  return tell_current(daemon.post("/api/v1/models/rollback", document_text(request)), json);
}

ExitCode applied_command(const ApiClient& daemon, const AppliedArguments& arguments, bool json) {
  const ApprovalRequest request{.operator_name = if_given(arguments.operator_name),
                                .valid_days = {},
                                .to = arguments.to,
                                .hash = if_given(arguments.hash)};
  const ApiReply reply = daemon.post("/api/v1/models/applied", document_text(request));
  if (reply.status != 200) return print_problem(reply, json);
  if (json) {
    fmt::print("{}\n", reply.body);
  } else {
    fmt::print("{}", terminal_text(table_of(read_reply(reply, read_models))));
  }
  return kExitDone;
}

ExitCode models_command(const ApiClient& daemon, bool json) {
  const ApiReply reply = daemon.get("/api/v1/models");
  if (reply.status != 200) return print_problem(reply, json);
  if (json) {
    fmt::print("{}\n", reply.body);
    return kExitDone;
  }
  const ModelsDocument page = read_reply(reply, read_models);
  if (page.models.empty()) {
    fmt::print("no model is approved; touchcal approve RUN makes that of an accepted run the cell's\n");
    return kExitDone;
  }
  const ExitCode told = tell_current(daemon.get("/api/v1/models/current"), false);
  fmt::print("\n{}", terminal_text(table_of(page)));
  return told;
}

}  // namespace cell
