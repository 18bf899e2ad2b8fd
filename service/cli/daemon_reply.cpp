#include "service/cli/daemon_reply.hpp"

#include <spdlog/fmt/fmt.h>

#include "service/base/terminal_text.hpp"
#include "service/documents/problem_document.hpp"

namespace cell {

void refuse_peer(const ApiReply& reply) {
  throw DaemonUnreachable(
      fmt::format("the server is not touchcald (status {}); check --daemon", reply.status));
}

std::string problem_line(const ApiReply& reply) {
  const ProblemDocument problem = read_reply(reply, read_problem);
  std::string line = problem.detail.value_or(reply.body);
  if (reply.status == 401)
    line = "the daemon requires its token: name its state directory with --state DIR, or set TOUCHCAL_TOKEN";
  if (problem.exits) {
    std::string exits;
    for (const std::string& exit : *problem.exits) exits += (exits.empty() ? "" : ", ") + exit;
    line += fmt::format(" (possible now: {})", exits);
  }
  return terminal_text(line);  // it may repeat what a request held
}

ExitCode print_problem(const ApiReply& reply, bool json_only) {
  const std::string line = problem_line(reply);
  if (json_only) fmt::print("{}\n", reply.body);
  fmt::print(stderr, "{}\n", line);
  switch (reply.status) {
    case 400:  // what was given is none of its kind
    case 401:
    case 403:
    case 404:  // no run, no recipe of that name
    case 422:
      return kExitUsage;
    default:
      return kExitRefused;
  }
}

}  // namespace cell
