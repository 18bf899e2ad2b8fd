#include <spdlog/fmt/fmt.h>

#include <stdexcept>

#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/command_documents.hpp"
#include "service/documents/result_document.hpp"

namespace cell {

ExitCode export_command(const ApiClient& daemon, const ExportArguments& arguments, bool json) {
  demand_run_id(arguments.run_id);
  const std::string run = "/api/v1/runs/" + arguments.run_id;
  const ApiReply arm = daemon.get(run + "/arm");
  if (arm.status != 200) return print_problem(arm, json);
  const ApiReply reply = daemon.get(run + "/result");
  if (reply.status != 200) return print_problem(reply, json);
  const ResultDocument result = read_result(reply.body);
  write_whole_file(arguments.arm_file, arm.body, arguments.overwrite);
  const std::vector<std::string> warnings =
      export_warnings(result.cell_frames, result.verdict.accepted, result.verdict.reasons);
  print_warnings(warnings);
  if (arguments.arm_file == "-") return kExitDone;
  if (json) {
    fmt::print("{}\n", document_text(ExportDocument{.run_id = arguments.run_id,
                                                    .arm_file = arguments.arm_file,
                                                    .verdict = {verdict_text(reply.body)},
                                                    .warnings = warnings}));
  } else {
    fmt::print("{}: the calibrated arm of run {}\n", arguments.arm_file, arguments.run_id);
  }
  return kExitDone;
}

}  // namespace cell
