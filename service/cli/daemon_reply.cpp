#include "service/cli/daemon_reply.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

namespace cell {

using nlohmann::json;

json parse_reply(const ApiReply& reply) {
  try {
    return json::parse(reply.body);
  } catch (const json::exception&) {
    throw DaemonUnreachable(
        fmt::format("the server is not touchcald (status {}); check --daemon", reply.status));
  }
}

ExitCode print_problem(const ApiReply& reply, bool json_only) {
  const json problem = parse_reply(reply);
  if (json_only) fmt::print("{}\n", reply.body);
  std::string line = problem.value("detail", reply.body);
  if (reply.status == 401)
    line = "the daemon requires its token: name its state directory with --state DIR, or set TOUCHCAL_TOKEN";
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

}  // namespace cell
