#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/machine/instance.hpp"
#include "sim_controller/val3/machine/machine.hpp"

namespace val3 {

struct Task {
  std::string name;
  const Instance* owner = nullptr;  // who created it: the only one that knows its name
  int priority = 10;                // lines of a turn
  int period_ticks = 0;             // 0: asynchronous
  std::optional<Ref> overrun;       // of a synchronous one
  bool drops_cycle = false;         // the next period is left out: the last one was too long
  int overruns = 0;
  std::vector<std::unique_ptr<Activation>> stack;
  std::size_t stack_bytes = 0;  // of run memory, that the calls on the stack take
  int status = 1;               // as taskStatus
  std::string error;            // in words
  bool waits = false;           // its line could not finish: no more lines in this tick
  int lines = 0;                // since it waited
  // Of the line that waits.
  const void* waits_in = nullptr;  // the instruction
  double waits_until_s = 0.0;
  std::optional<std::string> edited;  // what get(x) has of its variable, while a person edits it

  [[nodiscard]] Activation& here() { return *stack.back(); }
};

/// The tasks of an application and of its libraries, in turns (manual 6, pages 79 to 88).
class Tasks {
 public:
  Tasks(System& system, const MachineLimits& limits) : system_(system), limits_(limits) {}

  /// A tick of 4 ms: synchronous tasks whose period begins, in order of creation, then the others in turns
  /// of as many lines as their priority says. A task that waits is asked again in the next tick.
  void tick();

  /// RunFailure 29, 31, 32.
  Task& create(std::unique_ptr<Task> task);
  /// Living or stopped; null when there is none.
  Task* find(const Instance& owner, std::string_view name);
  /// It created a task that is still there.
  [[nodiscard]] bool has_task_of(const Instance& instance) const;
  /// Some task is in one of its programs.
  [[nodiscard]] bool runs_in(const Instance& instance) const;
  void kill(Task& task);
  void kill_all();
  /// Goes on `skip` lines from where it stands. RunFailure 90.
  void resume(Task& task, double skip);
  void fail(Task& task, int number, const std::string& text);

  /// A call begins; the arguments' places and copies are the caller's to fill.
  static std::unique_ptr<Activation> activate(const Code& code, Fathers& fathers);
  /// The innermost call of the task is over.
  void leave(Task& task);
  /// A program was called, or the task begins with it. RunFailure 41 where the run memory of the application
  /// that created the task does not hold it (program/run_memory.hpp), or this computer's share for all tasks.
  void enter(Task& task, std::unique_ptr<Activation> called);

  /// True when `seconds` have passed since this instruction of the task was first asked for; then it is asked
  /// anew. 0 or less is over at once.
  [[nodiscard]] bool is_over(Task& task, const void* instruction, double seconds) const;
  /// The instruction no longer waits.
  static void stop_waiting(Task& task) { task.waits_in = nullptr; }

  /// The line that is carried out moves so many values. It takes the time of one more line for every 256 of
  /// them, so that a tick has an end whatever its lines move.
  void charge(std::size_t values) { moved_values_ += values; }

  [[nodiscard]] bool empty() const { return tasks_.empty(); }
  [[nodiscard]] std::vector<TaskView> views() const;
  [[nodiscard]] std::uint64_t lines() const { return lines_; }
  [[nodiscard]] int most_lines(std::string_view name) const;
  void set_limits(const MachineLimits& limits) { limits_ = limits; }

  Fathers fathers;
  /// Data that libSave has kept, by application; files are never written.
  std::map<const Application*, std::vector<std::shared_ptr<ArrayBase>>> saved;
  std::map<int, std::string> half_read;  // by channel: of a string whose end has not come

 private:
  void demand_creatable(const Task& task);
  /// How many of `lines` it took, with the time of what they moved: it may be more.
  int run(Task& task, int lines);
  Flow carry_out(Task& task);
  void run_synchronous();
  void run_asynchronous();

  System& system_;
  MachineLimits limits_;
  std::list<std::unique_ptr<Task>> tasks_;
  std::map<std::string, int, std::less<>> most_lines_;
  std::uint64_t lines_ = 0;
  std::size_t moved_values_ = 0;  // by the line that is carried out
  long ticks_ = 0;
  std::size_t stack_bytes_ = 0;  // of the calls of all tasks
  const Task* turn_ = nullptr;   // whose turn the asynchronous lines of the next tick begin with
};

}  // namespace val3
