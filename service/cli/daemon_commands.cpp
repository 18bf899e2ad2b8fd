#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "service/cli/commands.hpp"
#include "service/cli/progress.hpp"
#include "service/cli/result_text.hpp"

namespace cell {
namespace {

using nlohmann::json;

/// How long a watcher waits for a change before it asks anew.
constexpr int kWaitSeconds = 10;

/// How long run waits for a cell that is being made ready.
constexpr int kReadyWaitSeconds = 5;

json parse_reply(const ApiReply& reply) {
  try {
    return json::parse(reply.body);
  } catch (const json::exception&) {
    throw DaemonUnreachable(
        fmt::format("what answers is no touchcald (status {}); check --daemon", reply.status));
  }
}

bool is_over(const json& status) {
  static const std::set<std::string> kOver{"STOPPED", "RESETTING", "IDLE", "COMPLETE", "ABORTED", "CLEARING"};
  return kOver.contains(status.at("state").get<std::string>());
}

ExitCode exit_code_of_end(const json& status) {
  const std::string verdict = status.at("verdict");
  if (verdict == "accepted") return kExitDone;
  if (verdict == "rejected") return kExitLimitsMissed;
  const json& fault = status.at("fault_code");
  return fault == "recipe_unreachable" || fault == "not_identifiable" ? kExitRefused : kExitFailed;
}

json wait_for_change(const ApiClient& daemon, const json& status, int wait_s) {
  const std::string target =
      fmt::format("/api/v1/status?wait_s={}&after={}", wait_s, status.at("sequence").get<std::uint64_t>());
  return parse_reply(daemon.get(target, std::chrono::seconds(wait_s + 10)));
}

/// A daemon that was just started is still looking for its controller: give it a moment.
void wait_until_ready(const ApiClient& daemon) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kReadyWaitSeconds);
  json status = parse_reply(daemon.get("/api/v1/status"));
  while (status.at("state") == "RESETTING" && std::chrono::steady_clock::now() < deadline) {
    status = wait_for_change(daemon, status, 1);
  }
}

/// Waits for the end of the run under way; returns the last status.
json watch_to_end(const ApiClient& daemon, bool silent) {
  Progress progress(isatty(STDOUT_FILENO) != 0);
  json status = parse_reply(daemon.get("/api/v1/status"));
  for (;;) {
    if (!silent) progress.show(status);
    // Where nobody sits who could resume, a run on hold with a fault is not waited for.
    const bool unattended = silent || isatty(STDOUT_FILENO) == 0;
    if (is_over(status) ||
        (unattended && status.at("state") == "HELD" && status.at("fault_code").is_string()))
      break;
    status = wait_for_change(daemon, status, kWaitSeconds);
  }
  progress.finish();
  return status;
}

ExitCode tell_end(const ApiClient& daemon, const json& status, bool json_only) {
  const ApiReply result =
      status.at("run_id").is_string()
          ? daemon.get("/api/v1/runs/" + status.at("run_id").get<std::string>() + "/result")
          : ApiReply{};
  if (json_only) {
    fmt::print("{}\n", result.status == 200 ? result.body : status.dump());
  } else if (result.status == 200) {
    fmt::print("\n{}{}", result_text(parse_reply(result)), more_text(status));
  } else {
    fmt::print("{}", status_text(status));
  }
  const ExitCode code = exit_code_of_end(status);
  if (code != kExitDone && code != kExitLimitsMissed) {
    fmt::print(
        stderr, "the run is in {}{}; {}\n", status.at("state").get<std::string>(),
        status.at("fault_message").is_string() ? ": " + status.at("fault_message").get<std::string>() : "",
        status.at("fault_next_step").is_string() ? status.at("fault_next_step").get<std::string>()
                                                 : "touchcal status tells more");
  }
  return code;
}

}  // namespace

ExitCode tell_problem(const ApiReply& reply, bool json_only) {
  const json problem = parse_reply(reply);
  if (json_only) fmt::print("{}\n", reply.body);
  std::string line = problem.value("detail", reply.body);
  if (reply.status == 401)
    line = "the daemon wants its token: name its state directory with --state DIR, or set TOUCHCAL_TOKEN";
  if (problem.contains("exits")) {
    std::string exits;
    for (const json& exit : problem["exits"]) exits += (exits.empty() ? "" : ", ") + exit.get<std::string>();
    line += fmt::format(" (possible now: {})", exits);
  }
  fmt::print(stderr, "{}\n", line);
  if (problem.value("type", "") == "urn:touchcal:problem:preconditions") return kExitFailed;
  if (reply.status == 422 || reply.status == 404 || reply.status == 401 || reply.status == 403)
    return kExitUsage;
  return kExitRefused;
}

ExitCode run_command(const ApiClient& daemon, const std::string& recipe, bool json_only) {
  wait_until_ready(daemon);
  const ApiReply reply = daemon.post("/api/v1/runs", json{{"recipe", recipe}}.dump());
  if (reply.status != 201) return tell_problem(reply, json_only);
  return tell_end(daemon, watch_to_end(daemon, json_only), json_only);
}

ExitCode watch_command(const ApiClient& daemon, bool json_only) {
  const json status = parse_reply(daemon.get("/api/v1/status"));
  if (is_over(status)) {
    fmt::print("{}", json_only ? status.dump() + "\n" : status_text(status));
    return kExitDone;
  }
  return tell_end(daemon, watch_to_end(daemon, json_only), json_only);
}

ExitCode status_command(const ApiClient& daemon, bool json_only) {
  const ApiReply reply = daemon.get("/api/v1/status");
  fmt::print("{}", json_only ? reply.body + "\n" : status_text(parse_reply(reply)));
  return kExitDone;
}

ExitCode runs_command(const ApiClient& daemon, bool json_only) {
  const ApiReply reply = daemon.get("/api/v1/runs");
  fmt::print("{}", json_only ? reply.body + "\n" : runs_text(parse_reply(reply)));
  return kExitDone;
}

void demand_run_id(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos)
    throw std::invalid_argument("'" + text + "' is no run's id; touchcal runs lists them");
}

ExitCode show_command(const ApiClient& daemon, const std::string& run_id, bool json_only) {
  demand_run_id(run_id);
  const ApiReply run = daemon.get("/api/v1/runs/" + run_id);
  if (run.status != 200) return tell_problem(run, json_only);
  const ApiReply result = daemon.get("/api/v1/runs/" + run_id + "/result");
  if (json_only) {
    fmt::print("{}\n", result.status == 200 ? result.body : run.body);
    return kExitDone;
  }
  fmt::print("{}", runs_text({{"runs", {parse_reply(run)}}}));
  const json fault = parse_reply(run).at("fault_message");
  if (fault.is_string()) fmt::print("fault: {}\n", fault.get<std::string>());
  if (result.status == 200) {
    fmt::print("\n{}", result_text(parse_reply(result)));
  } else {
    fmt::print("{}\n", parse_reply(result).value("detail", ""));
  }
  return kExitDone;
}

ExitCode give_command(const ApiClient& daemon, const std::string& command, bool json_only) {
  static const std::set<std::string> kOfTheRun{"pause", "resume", "abort"};
  std::string target = "/api/v1/cell/" + command;
  if (kOfTheRun.contains(command)) {
    const json status = parse_reply(daemon.get("/api/v1/status"));
    if (!status.at("run_id").is_string()) {
      fmt::print(stderr, "there is no run to {}; touchcal run RECIPE starts one\n", command);
      return kExitRefused;
    }
    target = "/api/v1/runs/" + status.at("run_id").get<std::string>() + "/" + command;
  }
  const ApiReply reply = daemon.post(target, {});
  if (reply.status != 202) return tell_problem(reply, json_only);
  fmt::print("{}", json_only ? reply.body + "\n" : status_text(parse_reply(reply)));
  return kExitDone;
}

}  // namespace cell
