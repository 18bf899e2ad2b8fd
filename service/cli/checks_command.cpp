#include <spdlog/fmt/fmt.h>

#include <string>

#include "service/cli/checks_text.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"

namespace cell {

ExitCode checks_command(const ApiClient& daemon, const std::string& of_run, bool json) {
  if (!of_run.empty()) demand_run_id(of_run);
  const ApiReply reply = daemon.get("/api/v1/checks" + (of_run.empty() ? "" : "?of_run=" + of_run));
  if (reply.status != 200) return print_problem(reply, json);
  if (json) {
    fmt::print("{}\n", reply.body);
  } else {
    fmt::print("{}", checks_text(read_reply(reply, read_checks)));
  }
  return kExitDone;
}

}  // namespace cell
