// Tasks and time (manual 6, pages 84 to 90).
#include <cmath>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/run_error.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

constexpr double kClockStepSeconds = 0.001;

Task* task_named(Context& context, const std::string& name) {
  return context.tasks.find(*context.here->code->instance, name);
}

Task& demanded(Context& context, const std::string& name) {
  Task* task = task_named(context, name);
  if (task == nullptr) throw RunFailure(kErrorNoTask, "there is no task " + name);
  return *task;
}

/// The line that is carried out: what a waiting instruction is known by.
const void* this_line(const Context& context) {
  return context.here->code->operations[context.here->next - 1].get();
}

bool watch(Context& context, const NodePtr<bool>& condition, double seconds) {
  const bool met = condition->get(context);
  if (met) {
    Tasks::stop_waiting(context.task);
    return true;
  }
  if (context.task.waits_in == this_line(context)) {
    if (context.tasks.is_over(context.task, this_line(context), 0.0)) return false;
    throw Wait{};
  }
  // Not met at once: the turn goes, however short the time is.
  (void)context.tasks.is_over(context.task, this_line(context), std::max(0.0, seconds));
  context.task.waits_in = this_line(context);
  throw Wait{};
}

Nothing take_mutex(Context&, const Out<bool>& mutex) {
  if (mutex.value()) throw Wait{};
  mutex.value() = true;
  return {};
}

double run_status(Context& context, const std::string& name) {
  const Task* task = task_named(context, name);
  return task == nullptr ? -1.0 : static_cast<double>(task->status);
}

}  // namespace

/// The condition is evaluated by the instruction itself, at each turn.
template <>
struct Argument<const NodePtr<bool>*> {
  using Made = NodePtr<bool>;
  static bool fits(const Expression& e) { return Argument<bool>::fits(e); }
  static Made make(Compiler& compiler, const Expression& e) { return compiler.value<bool>(e); }
  static const NodePtr<bool>* get(const Made& made, Context&) { return &made; }
};

void define_tasks(Builtins& list) {
  list.define<bool, const NodePtr<bool>*, double>(
      "watch", [](Context& c, const NodePtr<bool>* condition, double seconds) {
        return watch(c, *condition, seconds);
      });
  list.define<Nothing, Out<bool>>("setMutex", take_mutex);
  list.define<Nothing, std::string>("taskSuspend", [](Context& c, const std::string& name) {
    Task& task = demanded(c, name);
    if (task.status == 1) task.status = 0;
    return Nothing{};
  });
  list.define<Nothing, std::string, double>("taskResume",
                                            [](Context& c, const std::string& name, double skip) {
                                              c.tasks.resume(demanded(c, name), skip);
                                              return Nothing{};
                                            });
  list.define<Nothing, std::string>("taskKill", [](Context& c, const std::string& name) {
    if (Task* task = task_named(c, name)) c.tasks.kill(*task);
    return Nothing{};
  });
  list.define<double, std::string>("taskStatus", run_status);
  list.define<double>("clock", [](Context& c) {
    return std::floor(c.system.clock_s() / kClockStepSeconds + 1e-6) * kClockStepSeconds;
  });
  list.define<std::string, double>("help", [](Context&, double code) {
    return std::string(run_error_text(static_cast<int>(std::max(-1e6, std::min(1e6, code)))));
  });
}

}  // namespace val3
