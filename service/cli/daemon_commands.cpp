#include <spdlog/fmt/fmt.h>

#include <set>
#include <stdexcept>

#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/result_text.hpp"
#include "service/cli/verification_text.hpp"
#include "service/documents/command_documents.hpp"
#include "service/documents/problem_document.hpp"

namespace cell {

ExitCode status_command(const ApiClient& daemon, bool json_only) {
  const ApiReply reply = daemon.get("/api/v1/status");
  fmt::print("{}", json_only ? reply.body + "\n" : status_text(read_reply(reply, read_status)));
  return kExitDone;
}

ExitCode page_command(const ApiClient& reached, bool json_only) {
  const ApiClient daemon = reached.without_socket();  // the link is of its address
  const ApiReply access = [&] {
    try {
      return daemon.get("/api/v1/access");
    } catch (const DaemonUnreachable&) {
      reached.get("/api/v1/access");  // where nothing answers by the socket either, that is what is told
      throw DaemonUnreachable("touchcald answers by its socket, but not at " + daemon.url() +
                              ", where a browser would look; give its address with --daemon");
    }
  }();
  const std::string role = read_reply(access, read_access).role;
  const bool operates = role == "operate";
  const std::string link = daemon.url() + "/" + (operates ? "#token=" + *daemon.token() : "");
  fmt::print("{}\n", json_only ? document_text(PageLinkDocument{.role = role, .url = link}) : link);
  if (!operates) {
    fmt::print(stderr,
               "the page will only watch: there is no token that this daemon takes; give its --state "
               "directory, as a user who may read it\n");
  }
  return kExitDone;
}

ExitCode runs_command(const ApiClient& daemon, bool json_only) {
  const ApiReply reply = daemon.get("/api/v1/runs");
  const RunsDocument page = read_reply(reply, read_runs);
  fmt::print("{}", json_only ? reply.body + "\n" : runs_text(page.runs));
  for (const DamagedRunDocument& run : page.damaged)
    fmt::print(stderr, "run {} is damaged: {}\n", run.id, run.detail);
  return kExitDone;
}

void demand_run_id(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos)
    throw std::invalid_argument("'" + text + "' is no run's id; touchcal runs lists them");
}

ExitCode show_command(const ApiClient& daemon, const std::string& run_id, bool json_only) {
  demand_run_id(run_id);
  const ApiReply run = daemon.get("/api/v1/runs/" + run_id);
  if (run.status != 200) return print_problem(run, json_only);
  const ApiReply result = daemon.get("/api/v1/runs/" + run_id + "/result");
  if (json_only) {
    fmt::print("{}\n", result.status == 200 ? result.body : run.body);
    return kExitDone;
  }
  const RunDocument document = read_reply(run, read_run);
  fmt::print("{}", runs_text({document}));
  if (document.fault_message) fmt::print("fault: {}\n", *document.fault_message);
  if (const auto& from = document.imported_from)
    fmt::print("imported: it is run {} of cell '{}', taken in at {}\n", from->run_id, from->cell,
               from->imported_at);
  if (result.status == 200) {
    fmt::print("\n{}", read_reply(result, text_of_result));
  } else {
    fmt::print("{}\n", read_reply(result, read_problem).detail.value_or(""));
  }
  return kExitDone;
}

ExitCode give_command(const ApiClient& daemon, const std::string& command, bool json_only) {
  static const std::set<std::string> kOfTheRun{"pause", "resume", "abort", "retry", "skip"};
  std::string target = "/api/v1/cell/" + command;
  if (kOfTheRun.contains(command)) {
    const StatusDocument status = read_reply(daemon.get("/api/v1/status"), read_status);
    if (!status.run_id) {
      fmt::print(stderr, "there is no run to {}; touchcal run RECIPE starts one\n", command);
      return kExitRefused;
    }
    target = "/api/v1/runs/" + *status.run_id + "/" + command;
  }
  const ApiReply reply = daemon.post(target, {});
  if (reply.status != 202) return print_problem(reply, json_only);
  fmt::print("{}", json_only ? reply.body + "\n" : status_text(read_reply(reply, read_status)));
  return kExitDone;
}

}  // namespace cell
