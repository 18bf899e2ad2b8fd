#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_controller/controller.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {

/// A copy of a shipped cell whose two sides may be silent for as long as the protocol allows: the machine may
/// be busy with other tests.
inline std::string patient_cell(const Folder& folder, const std::string& name) {
  std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config", folder / "config",
                        std::filesystem::copy_options::recursive);
  const std::filesystem::path file = folder / ("config/cells/" + name + "/cell.json");
  std::ifstream in(file);
  nlohmann::json cell = nlohmann::json::parse(in);
  cell.at("deadlines").at("heartbeat_timeout_ms") = sim::kHeartbeatTimeoutMax.count();
  std::ofstream(file) << cell.dump();
  return file.string();
}

/// A daemon and a simulated controller on a shipped cell, each on a free port.
class RunningCell {
  /// A whole run fits into it on a machine that is busy with other tests.
  static constexpr std::chrono::seconds kPatience{240};

 public:
  /// `more`: options of cs8sim beside cell, address and speed.
  RunningCell(const std::string& name, const std::string& speed, const std::vector<std::string>& more = {})
      : cell_file_(patient_cell(folder_, name)),
        controller_(controller_call(cell_file_, speed, more), folder_ / "cs8sim.err"),
        controller_address_(controller_.wait_for_address()) {
    start_daemon();
  }

  void start_daemon() {
    daemon_.reset();
    daemon_.emplace(std::vector<std::string>{"touchcald", "--cell", cell_file_, "--listen", "127.0.0.1:0",
                                             "--controller", controller_address_, "--state", state()},
                    folder_ / "touchcald.err");
    url_ = "http://" + daemon_->wait_for_address();
  }

  [[nodiscard]] std::vector<std::string> call(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "touchcal");
    for (const std::string& argument : {std::string("--daemon"), url_, std::string("--state"), state()}) {
      arguments.push_back(argument);
    }
    return arguments;
  }
  Finished run(const std::vector<std::string>& arguments) const {
    return Process(call(arguments), folder_ / "call.err").wait();
  }
  nlohmann::json status() const { return nlohmann::json::parse(run({"status", "--json"}).out); }

  /// Polls as a supervisor does, until the run with this id has made so many touches. Before it starts, the
  /// status still has the touches of the previous run.
  void wait_for_touches(int count, const std::string& run_id = "1") const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    for (auto now = status(); now.at("run_id") != run_id || now.at("touches_done") < count; now = status()) {
      if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error(now.dump());
    }
  }

  void wait_for_state(const std::string& state) const { wait_for("state", state); }
  void wait_for_link() const { wait_for("controller_connected", true); }

  [[nodiscard]] const Folder& folder() const { return folder_; }
  Process& controller() { return controller_; }
  Process& daemon() { return *daemon_; }
  [[nodiscard]] std::filesystem::path store_file() const { return folder_ / "state" / "touchcal.sqlite"; }

  [[nodiscard]] std::string state() const { return (folder_ / "state").string(); }

 private:
  /// Polls until a field of the status has this value.
  void wait_for(const char* field, const nlohmann::json& value) const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    for (auto now = status(); now.at(field) != value; now = status()) {
      if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error(now.dump());
    }
  }

  static std::vector<std::string> controller_call(const std::string& cell_file, const std::string& speed,
                                                  const std::vector<std::string>& more) {
    std::vector<std::string> call{"cs8sim", "--cell", cell_file, "--listen", "127.0.0.1:0", "--speed", speed};
    call.insert(call.end(), more.begin(), more.end());
    return call;
  }

  Folder folder_;
  std::string cell_file_;
  Process controller_;
  std::string controller_address_;
  std::optional<Process> daemon_;
  std::string url_;
};

}  // namespace touchcal::testing
