#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/arm_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/command_documents.hpp"
#include "service/documents/result_document.hpp"
#include "service/exports/dh_tables.hpp"
#include "service/exports/urdf.hpp"

namespace cell {
namespace {

struct WantedFile {
  std::string file;
  std::string text;
  std::string_view what;  // for people
};

std::optional<std::string> named(const std::string& file) {
  return file.empty() ? std::nullopt : std::optional(file);
}

std::vector<WantedFile> wanted_files(const ExportArguments& arguments, const std::string& arm_text) {
  const std::string origin = fmt::format("the calibrated arm of run {}", arguments.run_id);
  const std::string& dh = arguments.dh_file;
  std::vector<WantedFile> wanted;
  if (!arguments.arm_file.empty()) wanted.push_back({arguments.arm_file, arm_text, "the calibrated arm"});
  if (arguments.urdf_file.empty() && dh.empty()) return wanted;
  const Arm arm = read_arm_text("the daemon's answer", arm_text);
  if (!arguments.urdf_file.empty())
    wanted.push_back({arguments.urdf_file, urdf_document(arm, origin), "the calibrated arm as a URDF robot"});
  if (!dh.empty())
    wanted.push_back({dh, dh.ends_with(".json") ? dh_json(arm, origin) : dh_csv(arm, origin),
                      "the calibrated arm as DH tables"});
  return wanted;
}

}  // namespace

ExitCode export_command(const ApiClient& daemon, const ExportArguments& arguments, bool json) {
  demand_run_id(arguments.run_id);
  std::vector<std::string> files;
  for (const std::string& file : {arguments.arm_file, arguments.urdf_file, arguments.dh_file})
    if (!file.empty()) files.push_back(file);
  if (files.empty()) throw std::invalid_argument("nothing to write; give --arm, --urdf or --dh with a FILE");
  demand_writable(files, arguments.overwrite);

  const std::string run = "/api/v1/runs/" + arguments.run_id;
  const ApiReply arm = daemon.get(run + "/arm");
  if (arm.status != 200) return print_problem(arm, json);
  const ApiReply reply = daemon.get(run + "/result");
  if (reply.status != 200) return print_problem(reply, json);
  const ResultDocument result = read_result(reply.body);
  const std::vector<WantedFile> wanted = wanted_files(arguments, arm.body);
  for (const WantedFile& one : wanted) write_whole_file(one.file, one.text, arguments.overwrite);

  const std::vector<std::string> warnings =
      export_warnings(result.cell_frames, result.verdict.accepted, result.verdict.reasons);
  print_warnings(warnings);
  if (std::ranges::find(files, "-") != files.end()) return kExitDone;
  if (json) {
    fmt::print("{}\n", document_text(ExportDocument{.run_id = arguments.run_id,
                                                    .arm_file = named(arguments.arm_file),
                                                    .urdf_file = named(arguments.urdf_file),
                                                    .dh_file = named(arguments.dh_file),
                                                    .verdict = {verdict_text(reply.body)},
                                                    .warnings = warnings}));
  } else {
    for (const WantedFile& one : wanted)
      fmt::print("{}: {} of run {}\n", one.file, one.what, arguments.run_id);
  }
  return kExitDone;
}

}  // namespace cell
