#include "sim_controller/run_command.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <variant>

#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "sim_controller/loaded_application.hpp"
#include "sim_controller/run_links.hpp"
#include "sim_controller/run_script.hpp"
#include "sim_controller/scripted_run.hpp"
#include "sim_controller/socket_run.hpp"

namespace sim {
namespace {

constexpr double kSecondsWithoutScript = 10.0;
constexpr double kSecondsBehindScript = 1.0;

/// Nothing where it is no script: that is told.
std::optional<std::vector<ScriptStep>> read_script(const std::string& file_name, std::ostream& error) {
  if (file_name.empty()) return std::vector<ScriptStep>{};
  std::ifstream file(file_name, std::ios::binary);
  if (!file) {
    error << file_name << ": cannot be read; give the path of a script with --script\n";
    return std::nullopt;
  }
  std::string text(kScriptBytesMax + 1, '\0');  // a device would have no end
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) {
    error << file_name << ": cannot be read; give the path of a script with --script\n";
    return std::nullopt;
  }
  auto parsed = parse_script(text);
  if (const auto* refused = std::get_if<ScriptError>(&parsed)) {
    const std::string line = refused->line > 0 ? ':' + std::to_string(refused->line) : "";
    error << file_name << line << ": " << refused->what << '\n';
    return std::nullopt;
  }
  return std::get<std::vector<ScriptStep>>(std::move(parsed));
}

/// Simulated seconds of the run.
double end_of(const RunCommand& command, const std::vector<ScriptStep>& steps, bool has_sockets) {
  if (command.seconds > 0.0) return command.seconds;
  if (!steps.empty() && steps.back().act.kind != ScriptAct::Kind::kSocket)
    return steps.back().at_s + kSecondsBehindScript;
  return has_sockets ? std::numeric_limits<double>::infinity() : kSecondsWithoutScript;
}

}  // namespace

int run_application(const RunCommand& command, std::ostream& out, std::ostream& error) {
  std::optional<std::vector<ScriptStep>> steps = read_script(command.script_file, error);
  if (!steps) return kCannotRun;
  const cell::Cell cell = cell::read_cell(command.cell_file);
  cell::demand_revolute(cell);
  const Plant plant = make_plant(cell, cell::read_truth(command.truth_file));
  const std::optional<val3::Application> application = loaded_application(command.application, error);
  if (!application) return kCannotRun;
  const RunLinks links = links_of(*application, cards_of(*steps));
  for (const std::string& note : links.not_there) error << note << '\n';
  if (const auto refused = unknown_signal(*steps, links)) {
    error << command.script_file << ':' << refused->line << ": " << refused->what << '\n';
    return kCannotRun;
  }
  std::vector<RunSocket> wanted = command.sockets;
  for (const ScriptStep& step : *steps) {
    if (step.act.kind == ScriptAct::Kind::kSocket)
      wanted.push_back(*run_socket_at(step.act.name, step.act.text));
  }
  const double until_s = end_of(command, *steps, !wanted.empty());
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  ScriptedRun run(plant, *application, *steps, command.seed, now, out);
  val3::Findings missing;
  if (!run.start(missing)) {
    tell_errors(missing, error);
    return kCannotRun;
  }
  if (wanted.empty()) {
    while (!run.is_over() && run.seconds() <= until_s) run.step();
    return run.summary() == 0 ? kRanWell : kRanWithFailures;
  }
  try {
    SocketRun sockets(run, wanted, *steps);
    sockets.run(until_s, command.speed);
    return run.summary() == 0 ? kRanWell : kRanWithFailures;
  } catch (const WrongSocket& wrong) {
    error << wrong.what() << '\n';
    return kWrongSocket;
  } catch (const SocketRefusal& refusal) {
    error << refusal.what() << '\n';
    return kNoSocket;
  }
}

}  // namespace sim
