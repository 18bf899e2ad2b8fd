#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "sim_controller/cabinet.hpp"
#include "sim_controller/operator.hpp"
#include "sim_controller/plant.hpp"
#include "sim_controller/run_links.hpp"
#include "sim_controller/run_script.hpp"
#include "sim_controller/run_watch.hpp"
#include "sim_controller/val3/machine/machine.hpp"
#include "sim_controller/val3_system.hpp"

namespace sim {

/// An application, the cell under it, and a script that is carried out, 4 ms of simulated time at a time.
/// What happens is told, a line each with the simulated time, and is written out at once. How fast time goes
/// is the caller's.
class ScriptedRun {
 public:
  /// Plant, application (resolved, without errors) and stream outlive the run. `date`: what the controller's
  /// clock shows when it begins.
  ScriptedRun(const Plant& plant, const val3::Application& application, std::vector<ScriptStep> steps,
              std::uint64_t seed, std::chrono::sys_seconds date, std::ostream& out);

  /// Starts it. False where this machine does not have what the application wants: that is found.
  bool start(val3::Findings& findings);
  /// What the script has for this time, then a tick of the application and of the cell.
  void step();

  /// The application has ended, or the script ended the run.
  [[nodiscard]] bool is_over() const { return is_over_; }
  /// The arm moves, or somebody at the cell is about to do something.
  [[nodiscard]] bool is_busy() const;
  /// Simulated, since the start.
  [[nodiscard]] double seconds() const;
  [[nodiscard]] Val3Channels& channels() { return system_.channels(); }

  void tell(const std::string& text);
  /// Tells what was not handled or carried out, the user page and where every task stands; returns how many
  /// failures there were.
  int summary();

 private:
  void carry_out(const ScriptStep& step);
  void at_panel(const ScriptAct& act);
  void at_channel(const ScriptStep& step);
  void expect(const ScriptStep& step);
  [[nodiscard]] std::optional<double> number_of(const std::string& place) const;
  [[nodiscard]] bool is_ending() const;
  void show_page();
  void refuse(const ScriptStep& step, const std::string& why);
  Val3SystemOptions options(std::chrono::sys_seconds date);

  const Plant& plant_;
  Cabinet cabinet_;
  Operator person_;
  std::int64_t ticks_ = 0;
  bool is_over_ = false;
  RunWatch watch_;
  RunLinks links_;
  std::vector<ScriptStep> steps_;
  Val3System system_;
  std::size_t next_ = 0;
  std::ostream& out_;
  const val3::Application& application_;
  std::optional<val3::Machine> machine_;
};

}  // namespace sim
