#include "sim_controller/run_watch.hpp"

#include <spdlog/fmt/fmt.h>

namespace sim {

void RunWatch::fail(const std::string& text) {
  ++failures_;
  tell_("FAILED " + text);
}

void RunWatch::look_at_power(const Panel& panel, const std::string& cause) {
  if (was_powered_ && !panel.powered) tell_("power is off: " + cause);
  was_powered_ = panel.powered;
}

void RunWatch::look_at_program(const val3::Machine& machine, const Val3System& system, bool is_ending) {
  look_at_moves(system, is_ending);
  look_at_tasks(machine);
}

void RunWatch::look_at_cell(const CabinetTick& seen, const Cabinet& cabinet, const Val3System& system) {
  const auto& collision = seen.sensed.collision;
  if (collision && !was_hit_) fail("collision: " + *collision);
  was_hit_ = collision.has_value();
  look_at_power(cabinet.panel, collision ? "of the collision, " + *collision : "by itself");
  look_at_moves(system, false);
}

/// The system itself puts the cause into the log.
void RunWatch::look_at_moves(const Val3System& system, bool is_ending) {
  const bool has_failed = system.move_error() != val3::kErrorNone;
  if (has_failed && !failed_move_) failed_move_ = system.why_move_failed();
  if (has_failed || !failed_move_) return;
  if (is_ending) return count_failed_move();
  tell_("the program handles the failed move: resetMotion()");
  failed_move_.reset();
  stopped_by_it_.clear();
}

/// A task that died and a period that was too short, each once.
void RunWatch::look_at_tasks(const val3::Machine& machine) {
  for (const val3::TaskView& task : machine.tasks()) {
    if (task.status > 1 && dead_.insert(task.name).second) {
      const std::string text = fmt::format("task {} ends with error {} at {}:{}: {}", task.name, task.status,
                                           task.file, task.line, task.error);
      if (task.status != val3::kErrorImpossibleMove) {
        fail(text);
      } else if (failed_move_) {
        stopped_by_it_.push_back(text);  // the machine has put it into the log
      }
    }
    if (task.overruns > 0 && late_.insert(task.name).second)
      fail(fmt::format("task {} did not end within its period", task.name));
  }
}

void RunWatch::count_failed_move() {
  if (!failed_move_) return;
  fail("error 150 was not handled by resetMotion(): " + *failed_move_);
  for (const std::string& task : stopped_by_it_) fail(task);
  failed_move_.reset();
  stopped_by_it_.clear();
}

int RunWatch::conclude(const Cabinet& cabinet) {
  count_failed_move();
  const Drives& drives = cabinet.drives;
  std::size_t left = 0;
  for (const Move& move : drives.braking ? drives.after_reset : drives.queue) {
    if (move.is_impossible) {
      fail("a stored move is impossible, its turn did not come: " + move.why_impossible);
    } else if (!move.is_connection) {
      ++left;
    }
  }
  if (left > 0)
    tell_(fmt::format("stored moves that were not completed: {}{}", left,
                      !cabinet.panel.powered ? "; the power is off"
                      : cabinet.panel.held   ? "; the arm is held"
                                             : ""));
  return failures_;
}

}  // namespace sim
