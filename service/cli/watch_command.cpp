// touchcal run, watch and locate: they follow the cell until the end.
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/progress.hpp"
#include "service/cli/result_text.hpp"

namespace cell {
namespace {

using nlohmann::json;

/// Longest wait for a change before the next request.
constexpr int kWaitSeconds = 10;

/// Longest wait of `run` for a cell that is being made ready.
constexpr int kReadyWaitSeconds = 5;

bool is_over(const json& status) {
  static const std::set<std::string> kOver{"STOPPED", "RESETTING", "IDLE", "COMPLETE", "ABORTED", "CLEARING"};
  return kOver.contains(status.at("state").get<std::string>());
}

/// `end` is a status or, if another run is under way by now, the document of the run.
ExitCode exit_code_of_end(const json& end) {
  const std::string verdict = end.at("verdict");
  if (verdict == "accepted") return kExitDone;
  if (verdict == "rejected") return kExitLimitsMissed;
  const json& fault = end.at("fault_code");
  return fault == "recipe_unreachable" || fault == "not_identifiable" ? kExitRefused : kExitFailed;
}

json wait_for_change(const ApiClient& daemon, const json& status, int wait_s) {
  const std::string target =
      fmt::format("/api/v1/status?wait_s={}&after={}", wait_s, status.at("sequence").get<std::uint64_t>());
  return parse_reply(daemon.get(target, std::chrono::seconds(wait_s + 10)));
}

/// Waits for a daemon that was just started and still connects to its controller. Guided runs need only the
/// connection; in manual mode nothing else is ready.
void wait_until_ready(const ApiClient& daemon, bool guided) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kReadyWaitSeconds);
  json status = parse_reply(daemon.get("/api/v1/status"));
  const auto is_on_its_way = [&] {
    return status.at("state") == "RESETTING" && !(guided && status.at("controller_connected") == true);
  };
  while (is_on_its_way() && std::chrono::steady_clock::now() < deadline) {
    status = wait_for_change(daemon, status, 1);
  }
}

std::string run_target(const json& run_id) { return "/api/v1/runs/" + run_id.get<std::string>(); }

/// Follows one run to its end; its last status, or its own document when another run is under way by then.
json watch_to_end(const ApiClient& daemon, const json& run_id, bool silent) {
  Progress progress(isatty(STDOUT_FILENO) != 0);
  json status = parse_reply(daemon.get("/api/v1/status"));
  for (;;) {
    if (status.at("run_id") != run_id) {
      status = parse_reply(daemon.get(run_target(run_id)));
      break;
    }
    if (!silent) progress.show(status);
    // Without a person who could resume, a run that a fault holds is not waited for.
    const bool unattended = silent || isatty(STDOUT_FILENO) == 0;
    if (is_over(status) ||
        (unattended && status.at("state") == "HELD" && status.at("fault_code").is_string()))
      break;
    status = wait_for_change(daemon, status, kWaitSeconds);
  }
  progress.finish();
  return status;
}

ExitCode tell_end(const ApiClient& daemon, const json& run_id, const json& end, bool json_only) {
  const ApiReply result = daemon.get(run_target(run_id) + "/result");
  const bool is_status = end.contains("state");
  if (json_only) {
    fmt::print("{}\n", result.status == 200 ? result.body : end.dump());
  } else if (result.status == 200) {
    fmt::print("\n{}{}", result_text(parse_reply(result)), is_status ? more_text(end) : "");
  } else {
    fmt::print("{}", is_status ? status_text(end) : runs_text({{"runs", {end}}}));
  }
  const ExitCode code = exit_code_of_end(end);
  if (code == kExitDone || code == kExitLimitsMissed) return code;
  const auto text_at = [&end](const char* key) {
    return end.contains(key) && end[key].is_string() ? end[key].get<std::string>() : std::string();
  };
  const std::string message = text_at("fault_message"), next = text_at("fault_next_step");
  fmt::print(stderr, "the run is {}{}{}; {}\n", is_status ? "in " : "",
             text_at(is_status ? "state" : "outcome"), message.empty() ? "" : ": " + message,
             next.empty() ? "touchcal status tells more" : next);
  return code;
}

json run_body(const RunArguments& arguments) {
  json body;
  if (arguments.plan_id.empty()) {
    body["recipe"] = arguments.recipe;
  } else {
    body["plan_id"] = arguments.plan_id;
  }
  if (!arguments.operator_name.empty()) body["operator"] = arguments.operator_name;
  if (arguments.guided) body["touching"] = "guided";
  return body;
}

std::string place_text(const json& place) {
  if (!place.is_object()) return {};
  const auto line = [&](const char* name, const char* value, const char* deviation, const char* unit) {
    const json &v = place.at(value), &s = place.at(deviation);
    return fmt::format("{:<12}{:.2f} {:.2f} {:.2f} {} (std {:.2f} {:.2f} {:.2f})\n", name, v[0].get<double>(),
                       v[1].get<double>(), v[2].get<double>(), unit, s[0].get<double>(), s[1].get<double>(),
                       s[2].get<double>());
  };
  return line("shift", "shift_mm", "std_shift_mm", "mm") +
         line("turn", "turn_deg", "std_turn_deg", "degrees");
}

}  // namespace

ExitCode run_command(const ApiClient& daemon, const RunArguments& arguments, bool json_only) {
  wait_until_ready(daemon, arguments.guided);
  const ApiReply reply = daemon.post("/api/v1/runs", run_body(arguments).dump());
  if (reply.status != 201) return print_problem(reply, json_only);
  const json run_id = parse_reply(reply).at("id");
  return tell_end(daemon, run_id, watch_to_end(daemon, run_id, json_only), json_only);
}

ExitCode watch_command(const ApiClient& daemon, bool json_only) {
  const json status = parse_reply(daemon.get("/api/v1/status"));
  if (is_over(status) || !status.at("run_id").is_string()) {
    fmt::print("{}", json_only ? status.dump() + "\n" : status_text(status));
    return kExitDone;
  }
  const json run_id = status.at("run_id");
  return tell_end(daemon, run_id, watch_to_end(daemon, run_id, json_only), json_only);
}

ExitCode locate_command(const ApiClient& daemon, bool json_only) {
  const json place_before = parse_reply(daemon.get("/api/v1/cell")).at("place");
  const ApiReply reply = daemon.post("/api/v1/cell/locate", {});
  if (reply.status != 202) return print_problem(reply, json_only);
  json status = parse_reply(reply);
  std::string said;
  const bool passes = status.at("by_hand_step") == "passing";
  const auto is_found = [&] { return !passes && status.at("by_hand_step") == "pass"; };
  do {
    if (!json_only && guidance(status) != said) fmt::print("{}\n", said = guidance(status));
    std::fflush(stdout);
    if (is_found() || (passes && status.at("by_hand_step") == "pass")) break;
    status = wait_for_change(daemon, status, kWaitSeconds);
  } while (status.at("by_hand") == "locate");
  const bool failed = status.at("fault_code").is_string();
  const ApiReply cell = daemon.get("/api/v1/cell");
  if (!failed && !is_found() && parse_reply(cell).at("place") == place_before) {
    fmt::print(
        stderr,
        "locating was interrupted: no new pose is stored; touchcal locate continues or starts again\n");
    return kExitFailed;
  }
  if (json_only) {
    fmt::print("{}\n", failed || is_found() ? status.dump() : cell.body);
  } else if (failed) {
    fmt::print(stderr, "{}; {}\n", status.at("fault_message").get<std::string>(),
               status.at("fault_next_step").get<std::string>());
  } else if (!is_found()) {
    fmt::print("{}", place_text(parse_reply(cell).at("place")));
  }
  return failed ? kExitFailed : kExitDone;
}

}  // namespace cell
