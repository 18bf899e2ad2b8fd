#include "sim_controller/val3/machine/tasks.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "sim_controller/val3/program/run_memory.hpp"

namespace val3 {
namespace {

constexpr std::size_t kTaskNameBytesMax = 15;
constexpr std::size_t kSynchronousPeriodsMax = 2;
/// Activations of one program that are kept for its next calls.
constexpr std::size_t kIdleMax = 64;
/// Larger ones are not kept: their memory is that of the calls that run.
constexpr std::size_t kIdleBytesMax = 16'384;
/// A line that moves so many takes the time of one more line.
constexpr std::size_t kValuesOfALine = 256;
/// Clocks of two sources agree by this.
constexpr double kInstantSeconds = 1e-9;

bool is_task_name(std::string_view name) {
  return !name.empty() && name.size() <= kTaskNameBytesMax && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '~';
  });
}

/// What is handed by value, where the call before has made another number of elements of it.
void be_one_value(ArrayBase& parameter) {
  static const Declaration kOneValue;
  if (parameter.sizes != kOneValue.sizes) restore(parameter, kOneValue);
}

void number_fathers(Activation& call, Fathers& fathers) {
  for (const auto& array : call.owned)
    if (array->type().kind == Kind::kFrame || array->type().kind == Kind::kTool)
      call.fathers.add(fathers, *array);
}

}  // namespace

std::unique_ptr<Activation> Tasks::activate(const Code& code, Fathers& fathers) {
  if (!code.idle.empty()) {
    auto again = std::move(code.idle.back());
    code.idle.pop_back();
    again->next = 0;
    again->branch_open = false;
    const std::size_t parameters = code.program->parameters.size();
    for (std::size_t i = 0; i < parameters; ++i)
      if (!code.program->parameters[i].by_reference) be_one_value(*again->slots[i].array);
    for (std::size_t i = 0; i < code.program->locals.size(); ++i)
      restore(*again->slots[parameters + i].array, code.program->locals[i]);
    number_fathers(*again, fathers);
    return again;
  }
  auto made = std::make_unique<Activation>();
  made->code = &code;
  const Application& application = *code.instance->application;
  const auto own = [&](const Declaration& declared) {
    auto array = make_variable(application, declared);
    made->slots.push_back({.array = array.get()});
    made->owned.push_back(std::move(array));
  };
  for (const Parameter& parameter : code.program->parameters) {
    if (parameter.by_reference) {
      made->slots.emplace_back();
    } else {
      own({.name = parameter.name, .type = parameter.type});
    }
  }
  for (const Declaration& local : code.program->locals) own(local);
  number_fathers(*made, fathers);
  return made;
}

void Tasks::leave(Task& task) {
  auto left = std::move(task.stack.back());
  task.stack.pop_back();
  left->fathers.give_back();
  const Code& code = *left->code;
  task.stack_bytes -= code.call_bytes;
  stack_bytes_ -= code.call_bytes;
  for (std::size_t i = 0; i < code.program->parameters.size(); ++i)
    if (code.program->parameters[i].by_reference) left->slots[i] = {};
  if (code.idle.size() < kIdleMax && code.call_bytes <= kIdleBytesMax) code.idle.push_back(std::move(left));
}

void Tasks::enter(Task& task, std::unique_ptr<Activation> called) {
  const std::size_t memory = run_memory_of(*task.owner->application);
  const std::size_t wanted = task.stack_bytes + called->code->call_bytes;
  if (wanted > memory)
    throw RunFailure(kErrorRunMemory, "run memory is exhausted: " + called->code->program->name +
                                          " would be call " + std::to_string(task.stack.size() + 1) +
                                          " on the stack, with " + std::to_string(wanted) +
                                          " bytes (estimated) of stackSize " + std::to_string(memory));
  if (task.stack.size() >= limits_.calls)
    throw RunFailure(kErrorRunMemory, "more than " + std::to_string(limits_.calls) +
                                          " nested calls: this simulator holds no more");
  const std::size_t all = stack_bytes_ + called->code->call_bytes + (tasks_.size() + 1) * kTaskBytes;
  if (all > limits_.run_memory_bytes)
    throw RunFailure(kErrorRunMemory, "all tasks together would take " + std::to_string(all) +
                                          " bytes of run memory (estimated): this simulator gives them " +
                                          std::to_string(limits_.run_memory_bytes));
  task.stack_bytes = wanted;
  stack_bytes_ += called->code->call_bytes;
  task.stack.push_back(std::move(called));
}

void Tasks::demand_creatable(const Task& task) {
  if (!is_task_name(task.name)) throw RunFailure(kErrorTaskName, "'" + task.name + "' is no name of a task");
  if (find(*task.owner, task.name) != nullptr)
    throw RunFailure(kErrorTaskExists, "there is a task " + task.name + " already");
  std::set<int> periods;
  for (const auto& other : tasks_)
    if (other->period_ticks != 0) periods.insert(other->period_ticks);
  if (task.period_ticks != 0) periods.insert(task.period_ticks);
  if (periods.size() > kSynchronousPeriodsMax)
    throw RunFailure(kErrorPeriods, "more than two synchronous periods");
}

Task& Tasks::create(std::unique_ptr<Task> task) {
  try {
    demand_creatable(*task);
  } catch (const RunFailure&) {
    while (!task->stack.empty()) leave(*task);
    throw;
  }
  tasks_.push_back(std::move(task));
  return *tasks_.back();
}

Task* Tasks::find(const Instance& owner, std::string_view name) {
  for (const auto& task : tasks_)
    if (task->owner == &owner && task->name == name && task->status != -1) return task.get();
  return nullptr;
}

bool Tasks::has_task_of(const Instance& instance) const {
  return std::ranges::any_of(
      tasks_, [&](const auto& task) { return task->owner == &instance && task->status != -1; });
}

bool Tasks::runs_in(const Instance& instance) const {
  return std::ranges::any_of(tasks_, [&](const auto& task) {
    return task->status != -1 && std::ranges::any_of(task->stack, [&](const auto& call) {
             return call->code->instance == &instance;
           });
  });
}

void Tasks::kill(Task& task) { task.status = -1; }

void Tasks::kill_all() {
  for (const auto& task : tasks_) task->status = -1;
}

void Tasks::resume(Task& task, double skip) {
  if (task.status == 1) return;
  Activation& here = task.here();
  const double to = static_cast<double>(here.next) + std::trunc(skip);
  if (to < 0 || to >= static_cast<double>(here.code->operations.size()))
    throw RunFailure(kErrorNoLine, "no line there to resume");
  here.next = static_cast<std::size_t>(to);
  here.branch_open = false;
  task.waits_in = nullptr;
  task.edited.reset();
  task.error.clear();
  task.status = 1;
}

void Tasks::fail(Task& task, int number, const std::string& text) {
  task.status = number;
  task.error = text;
  const Activation& here = *task.stack.back();
  const Program& program = *here.code->program;
  system_.log(task.name + " ends with error " + std::to_string(number) + " at " + program.file + ":" +
              std::to_string(program.lines[here.next].line) + ": " + text);
}

bool Tasks::is_over(Task& task, const void* instruction, double seconds) const {
  const double now_s = system_.clock_s();
  if (task.waits_in != instruction) {
    task.waits_in = instruction;
    task.waits_until_s = now_s + seconds;
  }
  if (now_s + kInstantSeconds < task.waits_until_s) return false;
  task.waits_in = nullptr;
  return true;
}

/// One line. A line that fails or waits is the one that is carried out next.
Flow Tasks::carry_out(Task& task) {
  Activation& here = task.here();
  const std::size_t line = here.next++;
  Context context{system_, *this, task, &here};
  try {
    const Flow flow = here.code->operations[line]->run(context);
    if (flow == Flow::kWait) here.next = line;
    return flow;
  } catch (const Wait&) {
    here.next = line;
    return Flow::kWait;
  } catch (const RunFailure& failure) {
    here.next = line;
    fail(task, failure.number, failure.what());
    return Flow::kWait;
  }
}

int Tasks::run(Task& task, int lines) {
  int left = lines;
  while (left > 0 && task.status == 1 && !task.waits) {
    ++lines_;
    ++task.lines;
    const Flow flow = carry_out(task);
    left -= 1 + static_cast<int>(std::exchange(moved_values_, 0) / kValuesOfALine);
    if (flow == Flow::kGo) continue;
    if (flow == Flow::kEnded) task.status = -1;
    task.waits = true;
  }
  int& most = most_lines_[task.name];
  most = std::max(most, task.lines);
  if (task.waits) task.lines = 0;
  return lines - left;
}

void Tasks::run_synchronous() {
  // A task that a task creates has its first period in the next tick.
  const std::size_t count = tasks_.size();
  auto at = tasks_.begin();
  for (std::size_t i = 0; i < count; ++i, ++at) {
    Task& task = **at;
    if (task.period_ticks == 0 || task.status != 1 || ticks_ % task.period_ticks != 0) continue;
    if (std::exchange(task.drops_cycle, false)) continue;
    task.waits = false;
    run(task, limits_.lines_per_period);
    if (task.status != 1 || task.waits) continue;
    task.drops_cycle = true;
    ++task.overruns;
    task.overrun->at<bool>() = true;
  }
}

void Tasks::run_asynchronous() {
  for (const auto& task : tasks_)
    if (task->period_ticks == 0) task->waits = false;
  auto at = std::ranges::find_if(tasks_, [this](const auto& task) { return task.get() == turn_; });
  if (at == tasks_.end()) at = tasks_.begin();
  std::size_t idle = 0;  // tasks in a row that had nothing to do
  for (int left = limits_.lines_per_tick; left > 0 && idle < tasks_.size();) {
    Task& task = **at;
    if (++at == tasks_.end()) at = tasks_.begin();
    if (task.period_ticks != 0 || task.status != 1 || task.waits) {
      ++idle;
      continue;
    }
    idle = 0;
    left -= std::max(task.priority, run(task, task.priority));
  }
  turn_ = at == tasks_.end() ? nullptr : at->get();
}

void Tasks::tick() {
  run_synchronous();
  if (!tasks_.empty()) run_asynchronous();
  std::erase_if(tasks_, [this](const auto& task) {
    if (task->status != -1) return false;
    if (turn_ == task.get()) turn_ = nullptr;
    while (!task->stack.empty()) leave(*task);
    return true;
  });
  ++ticks_;
}

std::vector<TaskView> Tasks::views() const {
  std::vector<TaskView> views;
  for (const auto& task : tasks_) {
    if (task->status == -1 || task->stack.empty()) continue;
    const Activation& here = *task->stack.back();
    const Program& program = *here.code->program;
    views.push_back({.name = task->name,
                     .library = task->owner->alias,
                     .status = task->status,
                     .program = program.name,
                     .file = program.file,
                     .line = here.next < program.lines.size() ? program.lines[here.next].line : 0,
                     .error = task->error,
                     .overruns = task->overruns});
  }
  return views;
}

int Tasks::most_lines(std::string_view name) const {
  const auto found = most_lines_.find(name);
  return found == most_lines_.end() ? 0 : found->second;
}

}  // namespace val3
