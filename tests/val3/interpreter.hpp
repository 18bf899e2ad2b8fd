#pragma once

#include <list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/val3/cabinet.hpp"
#include "tests/val3/program.hpp"

namespace val3 {

struct Limits {
  int statements_per_period = 1000;     // of one synchronous task; more is an overrun
  int statements_per_tick = 4000;       // of all asynchronous tasks together
  int statements_without_wait = 50000;  // more is taken for an endless loop: error 60
  std::size_t calls = 20;               // nested; more is error 41
};
inline constexpr int kErrorInstructionTimeout = 60;

/// A program that runs, with its names; parameters by reference stand for places of the caller.
struct Activation {
  const Program* program = nullptr;
  std::size_t next = 0;
  std::map<std::string, Place, std::less<>> names;
};

struct Task {
  std::string name;
  std::vector<Activation> stack;
  int status = 1;  // 0 suspended, 1 running, above: run-time error
  int priority = 10;
  int period_ticks = 0;  // 0: not synchronous
  std::optional<Place> overrun;
  double wake_s = 0;
  std::optional<double> watch_until_s;
  bool waits = false;  // finished for this tick
  int statements = 0;  // since it waited last
  int most_statements = 0;
};

/// Runs an application in a cabinet, 4 ms at a time.
class Interpreter {
 public:
  /// Both must outlive it. The application's variables are used as they are: a second start finds them as the
  /// first run left them.
  Interpreter(const Application& application, Cabinet& cabinet, Limits limits = {})
      : application_(application), cabinet_(cabinet), limits_(limits), clock_before_s_(cabinet.clock_s) {}

  /// The main task NAME~ begins with `start`; `stop` runs in a task of its own, as when the operator ends the
  /// application.
  void start();
  void stop();
  /// 4 ms: synchronous tasks whose period begins, the others in turns, then arm and world.
  void tick();

  /// As VAL3's taskStatus: -1 when there is no such task.
  [[nodiscard]] int task_status(std::string_view name) const;
  /// Names of all tasks there are, also failed ones.
  [[nodiscard]] std::vector<std::string> tasks() const;
  /// Makes a task fail as if its current statement had raised `error`.
  void fail_task(std::string_view name, int error);
  void set_limits(const Limits& limits) { limits_ = limits; }
  /// Most statements that a task, living or dead, took between two waits.
  [[nodiscard]] const std::map<std::string, int>& most_statements() const { return most_statements_; }

 private:
  void create(Task task);
  void run(Task& task, int statements);
  void statement(Task& task);
  void call_program(Task& task, const Statement& s);
  void create_task(Task& task, const Statement& s);
  Activation activation(const std::string& program, const std::vector<Expression>& arguments,
                        std::size_t first, Task* caller);
  /// `wanted` says what values in braces are to be.
  Value evaluate(Task& task, const Expression& e, Type wanted = Type::kNone);
  Value instruction(Task& task, const Expression& e);
  Value task_instruction(Task& task, const Expression& e);
  Place place(Task& task, const Expression& e);
  bool truth(Task& task, const Expression& e);
  double number(Task& task, const Expression& e);
  std::string text(Task& task, const Expression& e);
  void assign(Task& task, const Statement& s);
  void error(Task& task, int number, const std::string& text);
  Task* find(std::string_view name);

  const Application& application_;
  Cabinet& cabinet_;
  Limits limits_;
  std::list<Task> tasks_;
  std::map<std::string, int> most_statements_;
  double clock_before_s_;
  long ticks_ = 0;
};

/// `sign` of two values, neither "and" nor "or". RuntimeError.
Value operate(const std::string& sign, const Value& left, const Value& right);

}  // namespace val3
