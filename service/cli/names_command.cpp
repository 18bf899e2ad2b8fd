#include <spdlog/fmt/fmt.h>

#include "config/cell.hpp"
#include "config/read_config.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/daemon_reply.hpp"
#include "service/documents/command_documents.hpp"
#include "service/documents/run_document.hpp"

namespace cell {

ExitCode names_of_cell_command(const std::string& what, const std::filesystem::path& cell_file) {
  const Cell cell = read_cell(cell_file);
  if (what == "tools") {
    fmt::print("stylus\n");
    for (const auto& [name, unused] : cell.tools) fmt::print("{}\n", name);
  } else if (what == "recipes") {
    for (const auto& [name, unused] : cell.recipes) fmt::print("{}\n", name);
  }
  return kExitDone;
}

ExitCode names_command(const ApiClient& daemon, const std::string& what) {
  if (what == "runs") {
    for (const RunSummary& run : read_reply(daemon.get("/api/v1/runs"), read_runs).runs)
      fmt::print("{}\n", run.id);
  } else if (what == "recipes") {
    for (const auto& recipe : read_reply(daemon.get("/api/v1/recipes"), read_recipe_names).recipes)
      fmt::print("{}\n", recipe.name);
  } else if (what == "tools") {  // of touchcal tool; compensate has a cell's file
    for (const std::string& tool : read_reply(daemon.get("/api/v1/cell"), read_tool_tips_of_cell))
      fmt::print("{}\n", tool);
  }
  return kExitDone;
}

}  // namespace cell
