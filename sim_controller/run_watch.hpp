#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim_controller/cabinet.hpp"
#include "sim_controller/val3/machine/machine.hpp"
#include "sim_controller/val3_system.hpp"

namespace sim {

/// Looks for what goes wrong in the run of an application, tells it once, and counts it. A failed move and
/// the tasks that it stops with error 150 are failures unless the program handles them: by resetMotion()
/// before it ends.
class RunWatch {
 public:
  using Tell = std::function<void(const std::string&)>;
  explicit RunWatch(Tell tell) : tell_(std::move(tell)) {}

  /// A failure of any kind.
  void fail(const std::string& text);

  /// Power that goes off is told with its cause, once. To be asked behind everything that can take it.
  void look_at_power(const Panel& panel, const std::string& cause);
  /// Behind each tick of the application. `is_ending`: it stops, so that its resetMotion() cleans up only.
  void look_at_program(const val3::Machine& machine, const Val3System& system, bool is_ending);
  /// Behind each tick of the cell.
  void look_at_cell(const CabinetTick& seen, const Cabinet& cabinet, const Val3System& system);

  /// At the end of the run: what was not handled, and what is left in the move store. Returns how many
  /// failures there were.
  int conclude(const Cabinet& cabinet);

 private:
  void look_at_moves(const Val3System& system, bool is_ending);
  void look_at_tasks(const val3::Machine& machine);
  void count_failed_move();

  Tell tell_;
  int failures_ = 0;
  std::optional<std::string> failed_move_;  // not handled yet
  std::vector<std::string> stopped_by_it_;  // tasks
  std::set<std::string> dead_;              // tasks that were told
  std::set<std::string> late_;
  bool was_powered_ = false;
  bool was_hit_ = false;
};

}  // namespace sim
