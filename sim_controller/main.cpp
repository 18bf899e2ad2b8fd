/// cs8sim simulates a CS8 controller with arm, probe and block. See sim_controller/README.md.
#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <charconv>
#include <chrono>
#include <csignal>
#include <iostream>
#include <memory>
#include <optional>

#include "config/block_place.hpp"
#include "config/decimal_text.hpp"
#include "config/fault_file.hpp"
#include "config/mounted_tool.hpp"
#include "config/option_text.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "sim_controller/control.hpp"
#include "sim_controller/fault_names.hpp"
#include "sim_controller/loaded_application.hpp"
#include "sim_controller/run_command.hpp"
#include "sim_controller/run_links.hpp"
#include "sim_controller/server.hpp"
#include "sim_controller/val3/check_command.hpp"
#include "sim_controller/val3_server.hpp"

namespace {

enum ExitCode { kDone = 0, kWrongUsage = 2, kBadInput = 3, kRefused = 4 };

constexpr double kSpeedLowest = 1e-3;
constexpr double kSpeedHighest = 1e3;

struct Arguments {
  std::string cell_file;
  std::string truth_file;
  std::string tool;  // on the arm in place of the probe
  std::string block = cell::kFirstPlace;
  std::string listen;
  std::string faults_file;
  std::string val3;
  std::string run;
  std::string script_file;
  std::vector<std::string> sockets;
  double run_seconds = 0.0;
  std::string control;
  std::uint64_t seed = 1;
  std::string speed = "1";
  int link_patience_ms = static_cast<int>(sim::kHeartbeatTimeoutMax.count());
  std::string check;  // folder of VAL3 projects; then nothing is simulated
  std::string language;
  bool json = false;
};

std::optional<double> parse_speed(const std::string& text) {
  if (text == "max") return sim::kSpeedMax;
  double speed = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, speed);
  if (error != std::errc{} || rest != end || !(speed >= kSpeedLowest && speed <= kSpeedHighest))
    return std::nullopt;
  return speed;
}

std::string check_listen(const std::string& text) {
  if (std::string refusal = cell::refuse_empty(text); !refusal.empty()) return refusal;
  return cell::parse_endpoint(text) ? "" : "'" + text + "' is not HOST:PORT";
}

std::string check_socket(const std::string& text) {
  return sim::parse_run_socket(text)
             ? ""
             : "'" + text + "' is not NAME=PLACE; NAME is the link of a sio, PLACE is " + sim::kRunSocketForm;
}

std::string check_speed(const std::string& text) {
  return parse_speed(text) ? "" : "'" + text + "' is neither a number from 0.001 to 1000 nor max";
}

std::string check_language(const std::string& text) {
  return val3::language_named(text) ? "" : "'" + text + "' is no version from s5 to s8, such as s7 or s6.4";
}

CLI::Option* add_check_options(CLI::App& app, Arguments& arguments) {
  CLI::Option* const folder =
      app.add_option(
             "--check", arguments.check,
             "checks the VAL3 projects in this folder and simulates nothing; ends with 0 when nothing "
             "above a note is found, else with 1, with 3 when they cannot be read")
          ->type_name("DIR")
          ->check(cell::refuse_empty);
  app.add_option("--language", arguments.language,
                 "of --check: the version to check against; default: each project's own")
      ->type_name("s5|s6|s7|s8")
      ->check(check_language)
      ->needs(folder);
  app.add_flag("--json", arguments.json, "of --check: findings as SARIF 2.1.0")->needs(folder);
  return folder;
}

int check(const Arguments& arguments) {
  val3::CheckCommand command{
      .folder = arguments.check, .language = {}, .json = arguments.json, .tool_version = TOUCHCAL_VERSION};
  if (!arguments.language.empty()) command.language = val3::language_named(arguments.language);
  return val3::run_check(command, std::cout, std::cerr);
}

/// The same for the other twin.
sim::Val3ServerOptions val3_options(const sim::ServerOptions& options) {
  sim::Val3ServerOptions same;
  same.controller.seed = options.controller.seed;
  same.controller.duties = options.controller.duties;
  same.controller.faults = options.faults;
  same.controller.plants = options.plants;
  // An application makes its session of the time since the controller was switched on: another at each start.
  constexpr std::uint32_t kUpSecondsMax = 900'000;
  same.controller.system.clock_s = options.controller.session % kUpSecondsMax;
  same.controller.system.date = std::chrono::sys_seconds(std::chrono::seconds(options.controller.session));
  same.speed = options.controller.speed;
  same.log = options.log;
  return same;
}

std::filesystem::path truth_file_of(const Arguments& arguments) {
  if (!arguments.truth_file.empty()) return arguments.truth_file;
  return std::filesystem::path(arguments.cell_file).parent_path() / "truth.json";
}

int run_script(const Arguments& arguments) {
  std::vector<sim::RunSocket> sockets;
  for (const std::string& text : arguments.sockets) sockets.push_back(*sim::parse_run_socket(text));
  return sim::run_application({.application = arguments.run,
                               .script_file = arguments.script_file,
                               .cell_file = arguments.cell_file,
                               .truth_file = truth_file_of(arguments).string(),
                               .seconds = arguments.run_seconds,
                               .seed = arguments.seed,
                               .sockets = std::move(sockets),
                               .speed = *parse_speed(arguments.speed)},
                              std::cout, std::cerr);
}

int serve(const Arguments& arguments) {
  cell::Cell cell = cell::read_cell(arguments.cell_file);
  cell::demand_revolute(cell);
  cell::Truth truth = cell::read_truth(truth_file_of(arguments));
  if (!arguments.tool.empty()) {
    const auto tip = cell.tool_tips.find(arguments.tool);
    if (tip == cell.tool_tips.end()) {
      std::cerr << "cs8sim: --tool: " << cell::why_no_tip(cell, arguments.tool) << '\n';
      return kWrongUsage;
    }
    truth = cell::with_tip_mounted(truth, tip->second);
    cell = cell::with_tool_mounted(cell, arguments.tool);
  }
  const cell::Endpoint endpoint =
      arguments.listen.empty() ? cell.controller : *cell::parse_endpoint(arguments.listen);

  sim::ServerOptions options;
  options.controller.seed = arguments.seed;
  options.controller.speed = *parse_speed(arguments.speed);
  options.controller.heartbeat_timeout_max = std::chrono::milliseconds(arguments.link_patience_ms);
  // Differs from one start to the next, as the session of a real controller does.
  options.controller.session = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
          .count());
  options.log = spdlog::default_logger();
  options.plants = sim::make_plants(cell, truth);
  const auto at_start = options.plants.find(arguments.block);
  if (at_start == options.plants.end()) {
    std::cerr << "cs8sim: --block: " << sim::no_such_place(options.plants, arguments.block) << '\n';
    return kWrongUsage;
  }
  if (!arguments.faults_file.empty()) {
    const cell::FaultFile faults = cell::read_faults(arguments.faults_file);
    options.faults = sim::planned(faults.faults);
    options.controller.duties = faults.duties;
  }

  std::optional<val3::Application> application;
  if (!arguments.val3.empty()) {
    application = sim::loaded_application(arguments.val3, std::cerr);
    if (!application) return kBadInput;
    for (const std::string& note : sim::links_of(*application, {}).not_there) std::cerr << note << '\n';
  }

  boost::asio::io_context io;
  std::unique_ptr<sim::ServedController> server;
  val3::Findings findings;
  std::optional<sim::Control> control;
  const auto listen = [](const cell::Endpoint& at, const char* option, const auto& begin) {
    try {
      begin();
    } catch (const boost::system::system_error& error) {
      std::cerr << "cs8sim: cannot listen on " << cell::endpoint_text(at) << ": " << error.code().message()
                << "; give another address with " << option << '\n';
      return false;
    }
    return true;
  };
  if (!listen(endpoint, "--listen", [&] {
        sim::Plant plant = at_start->second;
        if (application) {
          server = std::make_unique<sim::Val3Server>(io, endpoint.host, endpoint.port, std::move(plant),
                                                     *application, val3_options(options), findings);
        } else {
          server = std::make_unique<sim::Server>(io, endpoint.host, endpoint.port, std::move(plant), options);
        }
      })) {
    return kRefused;
  }
  if (sim::tell_errors(findings, std::cerr)) return kBadInput;
  if (!arguments.control.empty()) {
    const cell::Endpoint at = *cell::parse_endpoint(arguments.control);
    const auto answer = [&server](std::string_view line) { return sim::answer_control_line(*server, line); };
    if (!listen(at, "--control", [&] { control.emplace(io, at.host, at.port, answer); })) return kRefused;
    std::cerr << "control on " << cell::endpoint_text({at.host, control->port()}) << std::endl;
  }
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](boost::system::error_code, int) {
    server->stop();
    if (control) control->stop();
  });
  std::cout << "listening on " << cell::endpoint_text({endpoint.host, server->port()}) << std::endl;
  spdlog::info("cell {}, truth {}, seed {}, speed {}", cell.name, truth.name, arguments.seed,
               arguments.speed);
  io.run();
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_st("cs8sim"));
  spdlog::cfg::load_env_levels();
  CLI::App app("cs8sim: a simulated CS8 controller with a TX90, a touch probe and a block", "cs8sim");
  Arguments arguments;
  app.set_version_flag("--version", "cs8sim " TOUCHCAL_VERSION);
  app.add_option("--cell", arguments.cell_file, "cell file; all but --check needs it")
      ->type_name("FILE")
      ->check(cell::refuse_empty)
      ->excludes(add_check_options(app, arguments));
  app.add_option("--listen", arguments.listen,
                 "default: the cell's controller endpoint; port 0 takes a free one")
      ->type_name("HOST:PORT")
      ->check(check_listen);
  app.add_option(
         "--tool", arguments.tool,
         "a tool of the cell with a tip is on the arm in place of the probe, and trips its input; the "
         "truth's errors of frame 7 are those of the tool against its drawing")
      ->type_name("NAME")
      ->check(cell::refuse_empty);
  app.add_option("--block", arguments.block,
                 "where the block stands at the start: a place of its file; --control brings it to another")
      ->type_name("PLACE")
      ->check(cell::refuse_empty)
      ->capture_default_str();
  app.add_option("--truth", arguments.truth_file,
                 "what the cell hides; default: truth.json beside the cell file")
      ->type_name("FILE")
      ->check(cell::refuse_empty);
  app.add_option("--faults", arguments.faults_file, "what goes wrong, and what the operator leaves undone")
      ->type_name("FILE")
      ->check(cell::refuse_empty);
  app.add_option("--val3", arguments.val3,
                 "runs the VAL3 application in this folder instead of the C++ twin of touchcal's")
      ->type_name("DIR")
      ->check(cell::refuse_empty);
  auto* run = app.add_option("--run", arguments.run,
                             "runs the VAL3 application in this folder without a host, and ends")
                  ->type_name("DIR")
                  ->check(cell::refuse_empty);
  app.add_option("--script", arguments.script_file, "of --run: what is done to the application, and when")
      ->type_name("FILE")
      ->check(cell::refuse_empty)
      ->needs(run);
  app.add_option("--socket", arguments.sockets,
                 "of --run, for each socket that is to be a real one: the link of the application's sio, as "
                 "'Socket\\host' or host, and where; PORT makes it a server on 127.0.0.1 (0: any free port, "
                 "which is told), HOST:PORT a client that connects there. Time is wall time then, and "
                 "without --script and --for the run goes on until SIGINT or SIGTERM")
      ->type_name("NAME=[HOST:]PORT")
      ->check(check_socket)
      ->allow_extra_args(false)
      ->needs(run);
  app.add_option("--for", arguments.run_seconds,
                 "of --run: simulated seconds; default: to a second after the script's last line, without "
                 "one 10, with --socket without end")
      ->type_name("SECONDS")
      ->check(cell::refuse_number)
      ->check(CLI::Range(0.004, 86400.0))
      ->needs(run);
  app.add_option("--control", arguments.control,
                 "takes faults, jogs and the block's places while it runs, a line of JSON each; port 0 takes "
                 "a free one")
      ->type_name("HOST:PORT")
      ->check(check_listen);
  for (const char* of_a_server : {"--faults", "--listen", "--control", "--val3", "--block"})
    run->excludes(app.get_option(of_a_server));
  app.add_option("--seed", arguments.seed, "of the touch noise")
      ->type_name("N")
      ->check(cell::refuse_count64)
      ->capture_default_str();
  app.add_option("--speed", arguments.speed, "simulated against wall time; max: motions take no time")
      ->type_name("X|max")
      ->check(check_speed)
      ->capture_default_str();
  app.add_option(
         "--link-patience", arguments.link_patience_ms,
         "the longest silence that a host may ask for, where the machine stands still for seconds; no "
         "real controller waits so long")
      ->type_name("MS")
      ->check(cell::refuse_integer)
      ->check(CLI::Range(static_cast<int>(sim::kHeartbeatTimeoutMax.count()), 60'000))
      ->excludes(run)
      ->excludes(app.get_option("--val3"))
      ->capture_default_str();
  app.footer(
      "Motions take simulated time (--speed); deadlines, the silence that ends a link and the wait for a "
      "confirmation are wall time. With --val3 these are the application's and simulated too: it waits for "
      "the host's heartbeats.\nSPDLOG_LEVEL=debug in the environment logs each touch.");
  try {
    app.parse(argc, argv);
    if (arguments.check.empty() && arguments.cell_file.empty()) throw CLI::RequiredError("--cell");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  if (!arguments.check.empty()) return check(arguments);
  try {
    return arguments.run.empty() ? serve(arguments) : run_script(arguments);
  } catch (const cell::ConfigError& error) {
    std::cerr << error.what() << '\n';
    return kBadInput;
  }
}
