// touchcald: the daemon of one robot cell.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/daemon.hpp"
#include "service/exit_code.hpp"
#include "service/version.hpp"

namespace {

cell::Endpoint endpoint_option(const std::string& name, const std::string& text) {
  const auto endpoint = cell::parse_endpoint(text);
  if (!endpoint) throw CLI::ValidationError(name, "'" + text + "' is not HOST:PORT");
  return *endpoint;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("touchcald: drives the touches of one robot cell, identifies the arm, serves the JSON API");
  std::string cell_file, listen, controller, state;
  bool check = false;
  app.add_option("--cell", cell_file, "cell file, for example config/cells/demo/cell.json")->required();
  app.add_option("--listen", listen, "HOST:PORT of the API")->default_str("127.0.0.1:8080");
  app.add_option("--controller", controller, "HOST:PORT of the CS8; default: the cell file's");
  app.add_option("--state", state, "directory for runs and tokens; default: the user's state home");
  app.add_flag("--check", check, "read the cell and everything it names, then exit");
  app.set_version_flag("--version", std::string("touchcald ") + cell::kVersion);

  spdlog::set_default_logger(spdlog::stderr_color_mt("touchcald"));
  try {
    app.parse(argc, argv);
    cell::DaemonOptions options{.state_directory = state.empty() ? cell::default_state_directory()
                                                                 : std::filesystem::path(state)};
    if (!listen.empty()) options.listen = endpoint_option("--listen", listen);
    if (!controller.empty()) options.controller = endpoint_option("--controller", controller);
    const cell::Cell cell = cell::read_cell(cell_file);
    cell::demand_revolute(cell);
    if (check) {
      std::cout << cell_file << ": cell " << cell.name << " is in order\n";
      return cell::kExitDone;
    }
    cell::run_daemon(cell, options);
    return cell::kExitDone;
  } catch (const CLI::ParseError& error) {
    return app.exit(error, std::cout, std::cerr) == 0 ? cell::kExitDone : cell::kExitUsage;
  } catch (const cell::ConfigError& error) {
    std::cerr << error.what() << '\n';
    return cell::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "touchcald: " << error.what() << '\n';
    return cell::kExitFailed;
  }
}
