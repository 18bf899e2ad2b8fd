#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/offline.hpp"

namespace cell {

ExitCode export_command(const ApiClient& daemon, const ExportArguments& arguments, bool json) {
  demand_run_id(arguments.run_id);
  const std::string run = "/api/v1/runs/" + arguments.run_id;
  const ApiReply arm = daemon.get(run + "/arm");
  if (arm.status != 200) return print_problem(arm, json);
  const ApiReply reply = daemon.get(run + "/result");
  if (reply.status != 200) return print_problem(reply, json);
  const auto result = nlohmann::json::parse(reply.body);
  const nlohmann::json& verdict = result.at("verdict");
  write_whole_file(arguments.arm_file, arm.body, arguments.overwrite);
  const auto warnings =
      export_warnings(result.value("cell_frames", std::vector<int>()), verdict.at("accepted").get<bool>(),
                      verdict.at("reasons").get<std::vector<std::string>>());
  print_warnings(warnings);
  if (arguments.arm_file == "-") return kExitDone;
  if (json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"run_id", arguments.run_id},
                                              {"arm_file", arguments.arm_file},
                                              {"verdict", verdict},
                                              {"warnings", warnings}}
                           .dump());
  } else {
    fmt::print("{}: the calibrated arm of run {}\n", arguments.arm_file, arguments.run_id);
  }
  return kExitDone;
}

}  // namespace cell
