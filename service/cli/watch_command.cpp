// touchcal run, watch and locate: they follow the cell until the end.
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <variant>

#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/progress.hpp"
#include "service/cli/result_text.hpp"
#include "service/cli/verification_text.hpp"
#include "service/documents/command_documents.hpp"
#include "service/run/fault_table.hpp"

namespace cell {
namespace {

/// Longest wait for a change before the next request.
constexpr int kWaitSeconds = 10;

/// Longest wait of `run` for a cell that is being made ready.
constexpr int kReadyWaitSeconds = 5;

/// The last answer of the daemon about a run.
struct Answer {
  std::string body;
  /// The document of the run if another run is under way by now.
  std::variant<StatusDocument, RunDocument> document;
};

Answer status_answer(const ApiReply& reply) { return {reply.body, read_reply(reply, read_status)}; }

bool is_over(const StatusDocument& status) {
  constexpr std::array kOver{State::kStopped,  State::kResetting, State::kIdle,
                             State::kComplete, State::kAborted,   State::kClearing};
  return std::ranges::find(kOver, status.state) != kOver.end();
}

/// `complete`: it came to its end. A check that is part of the reference has no verdict then.
ExitCode exit_code_of_end(bool complete, Verdict verdict, const std::optional<std::string>& fault) {
  if (verdict == Verdict::kAccepted || (complete && verdict == Verdict::kNone)) return kExitDone;
  if (verdict == Verdict::kRejected) return kExitLimitsMissed;
  if (complete && !fault) return kExitRefused;  // the touches of another kind of run allow no verdict
  return fault == describe(FaultCode::kRecipeUnreachable).name ||
                 fault == describe(FaultCode::kNotIdentifiable).name
             ? kExitRefused
             : kExitFailed;
}

ApiReply wait_for_change(const ApiClient& daemon, const StatusDocument& status, int wait_s) {
  const std::string target = fmt::format("/api/v1/status?wait_s={}&after={}", wait_s, status.sequence);
  return daemon.get(target, std::chrono::seconds(wait_s + 10));
}

/// Waits for a daemon that was just started and still connects to its controller. Guided runs need only the
/// connection; in manual mode nothing else is ready.
void wait_until_ready(const ApiClient& daemon, bool guided) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kReadyWaitSeconds);
  StatusDocument status = read_reply(daemon.get("/api/v1/status"), read_status);
  const auto is_on_its_way = [&] {
    return status.state == State::kResetting && !(guided && status.controller_connected);
  };
  while (is_on_its_way() && std::chrono::steady_clock::now() < deadline) {
    status = read_reply(wait_for_change(daemon, status, 1), read_status);
  }
}

std::string run_target(const std::string& run_id) { return "/api/v1/runs/" + run_id; }

/// Follows one run to its end; its last status, or its own document when another run is under way by then.
Answer watch_to_end(const ApiClient& daemon, const std::string& run_id, bool silent) {
  Progress progress(isatty(STDOUT_FILENO) != 0);
  Answer answer = status_answer(daemon.get("/api/v1/status"));
  for (;;) {
    const StatusDocument& status = std::get<StatusDocument>(answer.document);
    if (status.run_id != run_id) {
      const ApiReply run = daemon.get(run_target(run_id));
      answer = {run.body, read_reply(run, read_run)};
      break;
    }
    if (!silent) progress.show(status);
    // Without a person who could resume, a run that a fault holds is not waited for.
    const bool unattended = silent || isatty(STDOUT_FILENO) == 0;
    if (is_over(status) || (unattended && status.state == State::kHeld && status.fault_code)) break;
    answer = status_answer(wait_for_change(daemon, status, kWaitSeconds));
  }
  progress.finish();
  return answer;
}

void print_failure(const Answer& end) {
  std::string where, message, next;
  if (const auto* status = std::get_if<StatusDocument>(&end.document)) {
    where = fmt::format("in {}", word_of(status->state));
    message = status->fault_message.value_or("");
    next = status->fault_next_step.value_or("");
  } else {
    const RunDocument& run = std::get<RunDocument>(end.document);
    where = word_of(run.outcome);
    message = run.fault_message.value_or("");
  }
  fmt::print(stderr, "the run is {}{}; {}\n", where, message.empty() ? "" : ": " + message,
             next.empty() ? "touchcal status tells more" : next);
}

ExitCode print_end(const ApiClient& daemon, const std::string& run_id, const Answer& end, bool json_only) {
  const ApiReply result = daemon.get(run_target(run_id) + "/result");
  const auto* status = std::get_if<StatusDocument>(&end.document);
  const auto* run = std::get_if<RunDocument>(&end.document);
  if (json_only) {
    fmt::print("{}\n", result.status == 200 ? result.body : sorted_text(end.body));
  } else if (result.status == 200) {
    fmt::print("\n{}{}", read_reply(result, text_of_result), status ? more_text(*status) : "");
  } else {
    fmt::print("{}", status ? status_text(*status) : runs_text({*run}));
  }
  const ExitCode code =
      status ? exit_code_of_end(status->state == State::kComplete, status->verdict, status->fault_code)
             : exit_code_of_end(run->outcome == RunOutcome::kComplete, run->verdict, run->fault_code);
  if (code != kExitDone && code != kExitLimitsMissed) print_failure(end);
  return code;
}

StartDocument start_request(const RunArguments& arguments) {
  StartDocument request;
  if (arguments.plan_id.empty()) {
    request.recipe = arguments.recipe;
  } else {
    request.plan_id = arguments.plan_id;
  }
  if (!arguments.operator_name.empty()) request.operator_name = arguments.operator_name;
  if (arguments.guided) request.touch_mode = "guided";
  request.arm_moving_min = arguments.arm_moving_min;
  request.block_temperature_c = arguments.block_temperature.celsius;
  request.std_block_temperature_k = arguments.block_temperature.std_k;
  if (!arguments.stiffness.empty()) request.stiffness = arguments.stiffness;
  return request;
}

ExitCode start_and_watch(const ApiClient& daemon, const StartDocument& request, bool json_only) {
  const ApiReply reply = daemon.post("/api/v1/runs", document_text(request));
  if (reply.status != 201) return print_problem(reply, json_only);
  const std::string run_id = read_reply(reply, read_run).id;
  return print_end(daemon, run_id, watch_to_end(daemon, run_id, json_only), json_only);
}

std::string place_text(const std::optional<PlaceDocument>& place) {
  if (!place) return {};
  const auto line = [](const char* name, const std::array<double, 3>& v, const std::array<double, 3>& s,
                       const char* unit) {
    return fmt::format("{:<12}{:.2f} {:.2f} {:.2f} {} (std {:.2f} {:.2f} {:.2f})\n", name, v[0], v[1], v[2],
                       unit, s[0], s[1], s[2]);
  };
  return line("shift", place->shift_mm, place->std_shift_mm, "mm") +
         line("turn", place->turn_deg, place->std_turn_deg, "degrees");
}

}  // namespace

ExitCode run_command(const ApiClient& daemon, const RunArguments& arguments, bool json_only) {
  wait_until_ready(daemon, arguments.guided);
  StartDocument request = start_request(arguments);
  if (arguments.plan_id.empty() && arguments.recipe.empty())
    request.recipe = read_reply(daemon.get("/api/v1/recipes"), read_recipe_names).default_name;
  return start_and_watch(daemon, request, json_only);
}

ExitCode verify_command(const ApiClient& daemon, const VerifyArguments& arguments, bool json_only) {
  wait_until_ready(daemon, !arguments.tool.empty());
  StartDocument request;
  request.kind = arguments.kind;
  if (!arguments.tool.empty()) request.tool = arguments.tool;
  if (!arguments.of_run.empty()) request.of_run = arguments.of_run;
  if (!arguments.operator_name.empty()) request.operator_name = arguments.operator_name;
  request.arm_moving_min = arguments.arm_moving_min;
  request.block_temperature_c = arguments.block_temperature.celsius;
  request.std_block_temperature_k = arguments.block_temperature.std_k;
  return start_and_watch(daemon, request, json_only);
}

ExitCode watch_command(const ApiClient& daemon, bool json_only) {
  const ApiReply reply = daemon.get("/api/v1/status");
  const StatusDocument status = read_reply(reply, read_status);
  if (is_over(status) || !status.run_id) {
    fmt::print("{}", json_only ? sorted_text(reply.body) + "\n" : status_text(status));
    return kExitDone;
  }
  const std::string run_id = *status.run_id;
  return print_end(daemon, run_id, watch_to_end(daemon, run_id, json_only), json_only);
}

ExitCode locate_command(const ApiClient& daemon, bool json_only) {
  const auto place_before = read_reply(daemon.get("/api/v1/cell"), read_place_of_cell);
  ApiReply reply = daemon.post("/api/v1/cell/locate", {});
  if (reply.status != 202) return print_problem(reply, json_only);
  StatusDocument status = read_reply(reply, read_status);
  std::string said;
  const bool passes = status.by_hand_step == HandStep::kPassing;
  const auto is_found = [&] { return !passes && status.by_hand_step == HandStep::kPass; };
  do {
    if (!json_only && guidance(status) != said) fmt::print("{}\n", said = guidance(status));
    std::fflush(stdout);
    if (is_found() || (passes && status.by_hand_step == HandStep::kPass)) break;
    reply = wait_for_change(daemon, status, kWaitSeconds);
    status = read_reply(reply, read_status);
  } while (status.by_hand == HandActivity::kLocate);
  const bool failed = status.fault_code.has_value();
  const ApiReply cell = daemon.get("/api/v1/cell");
  if (!failed && !is_found() && read_reply(cell, read_place_of_cell) == place_before) {
    fmt::print(
        stderr,
        "locating was interrupted: no new pose is stored; touchcal locate continues or starts again\n");
    return kExitFailed;
  }
  if (json_only) {
    fmt::print("{}\n", failed || is_found() ? sorted_text(reply.body) : cell.body);
  } else if (failed) {
    fmt::print(stderr, "{}; {}\n", status.fault_message.value(), status.fault_next_step.value());
  } else if (!is_found()) {
    fmt::print("{}", place_text(read_reply(cell, read_place_of_cell)));
  }
  return failed ? kExitFailed : kExitDone;
}

}  // namespace cell
