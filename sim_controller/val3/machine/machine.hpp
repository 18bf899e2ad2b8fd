#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/machine/system.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

struct MachineLimits {
  int lines_per_period = 3000;  // of one synchronous task (manual 6, page 81)
  int lines_per_tick = 4000;    // of all asynchronous tasks together
  // Nested calls of a task, whatever its stackSize: more than any controller's application makes. Error 41.
  std::size_t calls = 20'000;
  // Run memory of all tasks together, estimated, whatever their stackSize: what is estimated at 16 bytes, a
  // string, takes up to 200 of this computer. Error 41.
  std::size_t run_memory_bytes = 64U << 20U;
};

/// How a task stands.
struct TaskView {
  std::string name;
  std::string library;  // its alias; empty for the application's own
  int status = 1;       // as taskStatus: 0 stopped, 1 running, above a run-time error
  std::string program;  // where it is
  std::string file;
  int line = 0;
  std::string error;  // what failed, in words; empty while nothing did
  int overruns = 0;   // periods of a synchronous task that were too short for its lines
};

/// Runs an application on a system, 4 ms at a time.
class Machine {
 public:
  /// The application is resolved and without errors; it and the system outlive the machine. What this
  /// machine cannot carry out (an instruction of an option) is found with its place: then nothing runs.
  Machine(const Application& application, System& system, Findings& findings, MachineLimits limits = {});
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// The start task begins with start(). Variables are as they are: a second start finds what the first run
  /// left.
  void start();
  /// As from the pendant: the start task goes, stop() runs while the others live; then they go too.
  void stop();
  /// Tasks of one period of 4 ms; the system moves on by itself, before or after.
  void tick();

  /// No task is left, and stop() has run.
  [[nodiscard]] bool ended() const;
  [[nodiscard]] std::vector<TaskView> tasks() const;
  /// As taskStatus: -1 when there is no such task of the application.
  [[nodiscard]] int task_status(std::string_view name) const;
  /// The task stops as if its line had raised `error`. std::out_of_range when there is none of that name.
  void fail_task(std::string_view name, int error);
  void set_limits(const MachineLimits& limits);
  /// Lines that were carried out since the machine was made.
  [[nodiscard]] std::uint64_t lines() const;
  /// Most lines that a task, living or gone, took between two waits; 0 for a name that never was.
  [[nodiscard]] int most_lines(std::string_view task) const;

  /// A variable of the application, by name and flat index. std::out_of_range, std::bad_variant_access.
  [[nodiscard]] double number(std::string_view name, std::size_t index = 0) const;
  [[nodiscard]] bool truth(std::string_view name, std::size_t index = 0) const;
  [[nodiscard]] const std::string& text(std::string_view name, std::size_t index = 0) const;
  [[nodiscard]] const Joint& joint(std::string_view name, std::size_t index = 0) const;
  void set_number(std::string_view name, double value, std::size_t index = 0);
  void set_truth(std::string_view name, bool value, std::size_t index = 0);
  void set_text(std::string_view name, const std::string& value, std::size_t index = 0);
  void set_joint(std::string_view name, const Joint& value, std::size_t index = 0);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace val3
