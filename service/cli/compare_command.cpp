#include <spdlog/fmt/fmt.h>

#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/comparison_text.hpp"
#include "service/cli/daemon_reply.hpp"

namespace cell {

ExitCode compare_command(const ApiClient& daemon, const std::string& run, const std::string& other,
                         bool json) {
  demand_run_id(run);
  demand_run_id(other);
  const ApiReply reply = daemon.get("/api/v1/runs/" + run + "/comparison?with=" + other);
  if (reply.status != 200) return print_problem(reply, json);
  const ComparisonDocument document = read_reply(reply, read_comparison);
  fmt::print("{}", json ? reply.body + "\n" : comparison_text(document));
  return document.verdict.accepted.value_or(false) ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
