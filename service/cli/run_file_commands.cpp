#include <spdlog/fmt/fmt.h>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/command_documents.hpp"
#include "service/documents/run_document.hpp"
#include "service/documents/run_file.hpp"

namespace cell {
namespace {

constexpr std::chrono::seconds kTransferDeadline{60};

}  // namespace

ExitCode export_run_command(const ApiClient& daemon, const RunFileArguments& arguments, bool json) {
  demand_run_id(arguments.run_id);
  demand_writable({arguments.file}, arguments.overwrite);
  const ApiReply reply = daemon.get("/api/v1/runs/" + arguments.run_id + "/file", kTransferDeadline);
  if (reply.status != 200) return print_problem(reply, json);
  const ReadRunFile read = read_reply(reply, read_run_file);
  write_whole_file(arguments.file, reply.body, arguments.overwrite);
  if (arguments.file == "-") return kExitDone;
  if (json) {
    fmt::print("{}\n", document_text(ExportedRunDocument{.run_id = arguments.run_id,
                                                         .cell = read.file.cell,
                                                         .file = arguments.file,
                                                         .sha256 = read.sha256}));
  } else {
    fmt::print("{}: run {} of cell '{}', {} touches, {}\n", arguments.file, arguments.run_id, read.file.cell,
               read.file.copy.touches.size(),
               read.file.model_json ? "with its approved model" : "with no approved model");
  }
  return kExitDone;
}

ExitCode import_run_command(const ApiClient& daemon, const std::string& file, bool json) {
  const std::string bytes = read_file_bytes(file, kRunFileBytesMax);
  ReadRunFile read;
  try {
    read = read_run_file(bytes);
  } catch (const DocumentError& error) {
    throw ConfigError(file, "", error.what());
  }
  const ApiReply reply = daemon.post("/api/v1/runs/import", bytes, kTransferDeadline);
  if (reply.status != 201) return print_problem(reply, json);
  if (json) {
    fmt::print("{}\n", reply.body);
    return kExitDone;
  }
  const RunDocument run = read_reply(reply, read_run);
  fmt::print("run {} of cell '{}' is run {} here; touchcal show {}\n", read.file.copy.run.id, read.file.cell,
             run.id, run.id);
  return kExitDone;
}

}  // namespace cell
