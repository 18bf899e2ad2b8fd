#include "tests/val3/interpreter.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/val3/instructions.hpp"

namespace val3 {
namespace {

/// A digital input or output stands for its state.
Value state_of(const Cabinet& cabinet, const Value& value) {
  const Dio* dio = std::get_if<Dio>(&value);
  if (dio == nullptr) return value;
  for (const auto* side : {&cabinet.inputs, &cabinet.outputs})
    if (const auto found = side->find(dio->link); found != side->end()) return found->second;
  throw RuntimeError(kErrorNotLinked, dio->link + " is not there");
}

int period_in_ticks(double period_s) {
  const double ticks = period_s / kTickSeconds;
  if (ticks < 0.5 || std::abs(ticks - std::round(ticks)) > 1e-9)
    throw RuntimeError(kErrorSyncPeriods, "a period that is no multiple of 4 ms");
  return static_cast<int>(std::round(ticks));
}

}  // namespace

void Interpreter::start() {
  Task main{.name = application_.name + "~"};
  main.stack.push_back(activation("start", {}, 0, nullptr));
  create(std::move(main));
}

void Interpreter::stop() {
  Task ending{.name = "stop~"};
  ending.stack.push_back(activation("stop", {}, 0, nullptr));
  create(std::move(ending));
}

void Interpreter::tick() {
  for (Task& task : tasks_) {
    if (task.status != 1) continue;
    if (task.period_ticks == 0) {
      if (task.wake_s <= cabinet_.clock_s + 1e-9) task.waits = false;
    } else if (ticks_ % task.period_ticks == 0) {
      if (!task.waits) task.overrun->write(true);
      if (task.wake_s <= cabinet_.clock_s + 1e-9) task.waits = false;
      if (!task.waits) run(task, limits_.statements_per_period);
    }
  }
  bool anyone = true;
  for (int left = limits_.statements_per_tick; left > 0 && anyone;) {
    anyone = false;
    for (Task& task : tasks_) {
      if (task.period_ticks != 0 || task.status != 1 || task.waits) continue;
      run(task, task.priority);
      left -= task.priority;
      anyone = true;
    }
  }
  std::erase_if(tasks_, [](const Task& task) { return task.status == -1; });
  for (int i = 0; i < static_cast<int>(std::round(kTickSeconds / kStepSeconds)); ++i) cabinet_.step();
  ++ticks_;
  cabinet_.clock_s = clock_before_s_ + static_cast<double>(ticks_) * kTickSeconds;
}

void Interpreter::run(Task& task, int statements) {
  for (int i = 0; i < statements && task.status == 1 && !task.waits; ++i) {
    const std::string at = task.stack.back().program->file + ":" +
                           std::to_string(task.stack.back().program->statements[task.stack.back().next].line);
    try {
      if (++task.statements > limits_.statements_without_wait)
        throw RuntimeError(kErrorInstructionTimeout, "an endless loop");
      statement(task);
    } catch (const RuntimeError& e) {
      error(task, e.number, at + ": " + e.what());
    }
    int& most = most_statements_[task.name];
    most = std::max(most, task.statements);
    if (task.waits) task.statements = 0;
    if (task.stack.empty()) task.status = -1;
  }
}

void Interpreter::statement(Task& task) {
  const std::size_t depth = task.stack.size() - 1;
  const std::size_t index = task.stack[depth].next++;
  const Statement& s = task.stack[depth].program->statements[index];
  const auto jump_unless = [&](bool condition) {
    if (!condition) task.stack[depth].next = s.target;
  };
  try {
    switch (s.kind) {
      case StatementKind::kAssign:
        assign(task, s);
        break;
      case StatementKind::kInstruction:
        instruction(task, s.expressions[0]);
        break;
      case StatementKind::kCall:
        call_program(task, s);
        break;
      case StatementKind::kTaskCreate:
      case StatementKind::kTaskCreateSync:
        create_task(task, s);
        break;
      case StatementKind::kJump:
        jump_unless(false);
        break;
      case StatementKind::kJumpUnless:
        jump_unless(truth(task, s.expressions[0]));
        break;
      case StatementKind::kJumpUnlessFor: {
        const double counter = number(task, s.expressions[0]);
        const double last = number(task, s.expressions[1]);
        jump_unless(number(task, s.expressions[2]) > 0 ? counter <= last : counter >= last);
        break;
      }
      case StatementKind::kJumpUnlessCase: {
        const Value selector = evaluate(task, s.expressions[0]);
        jump_unless(std::any_of(s.expressions.begin() + 1, s.expressions.end(), [&](const Expression& e) {
          return std::get<bool>(operate("==", selector, evaluate(task, e)));
        }));
        break;
      }
      case StatementKind::kReturn:
        task.stack.pop_back();
        break;
    }
  } catch (const Blocked&) {
    task.stack[depth].next = index;
    task.waits = true;
  }
}

void Interpreter::assign(Task& task, const Statement& s) {
  const Place target = place(task, s.expressions[0]);
  const Value before = target.read();
  const Value value = evaluate(task, s.expressions[1], type_of(before));
  if (const Dio* output = std::get_if<Dio>(&before)) {
    if (cabinet_.inputs.contains(output->link)) throw RuntimeError(kErrorWriteToInput, output->link);
    if (!cabinet_.outputs.contains(output->link)) throw RuntimeError(kErrorNotLinked, output->link);
    cabinet_.outputs[output->link] = std::get<bool>(state_of(cabinet_, value));
    return;
  }
  target.write(std::holds_alternative<bool>(before) ? state_of(cabinet_, value) : value);
}

Activation Interpreter::activation(const std::string& program, const std::vector<Expression>& arguments,
                                   std::size_t first, Task* caller) {
  const Program& called = application_.programs.at(program);
  Activation result{.program = &called};
  for (std::size_t i = 0; i < called.parameters.size(); ++i) {
    const Parameter& parameter = called.parameters[i];
    const Expression& argument = arguments.at(first + i);
    if (parameter.by_reference) {
      result.names[parameter.name] = place(*caller, argument);
    } else {
      const Value value = evaluate(*caller, argument, parameter.type);
      const Place copy = new_variable(parameter.type, 1);
      copy.write(parameter.type == Type::kBool ? state_of(cabinet_, value) : value);
      if (parameter.type == Type::kFrame)
        std::get<Frame>((*copy.elements)[0]).name = std::get<Frame>(value).name;
      result.names[parameter.name] = copy;
    }
  }
  for (const Local& local : called.locals) result.names[local.name] = new_variable(local.type, local.size);
  return result;
}

void Interpreter::call_program(Task& task, const Statement& s) {
  if (task.stack.size() >= limits_.calls) throw RuntimeError(kErrorStack, "calls nested too deeply");
  task.stack.push_back(activation(s.program, s.expressions, 0, &task));
}

void Interpreter::create_task(Task& task, const Statement& s) {
  const bool is_sync = s.kind == StatementKind::kTaskCreateSync;
  Task created{.name = text(task, s.expressions[0])};
  const double second = number(task, s.expressions[1]);
  if (is_sync) {
    created.period_ticks = period_in_ticks(second);
    created.overrun = place(task, s.expressions[2]);
    created.waits = true;
  } else {
    if (second < 1 || second > 100) throw RuntimeError(kErrorParameter, "a priority out of 1..100");
    created.priority = static_cast<int>(second);
  }
  created.stack.push_back(activation(s.program, s.expressions, is_sync ? 3 : 2, &task));
  create(std::move(created));
}

void Interpreter::create(Task task) {
  if (task.name.empty() || task.name.size() > 15) throw RuntimeError(29, "a task's name");
  if (find(task.name) != nullptr) throw RuntimeError(kErrorTaskName, "a second task " + task.name);
  std::set<int> periods;
  for (const Task& other : tasks_)
    if (other.period_ticks != 0 && other.status != -1) periods.insert(other.period_ticks);
  if (task.period_ticks != 0) periods.insert(task.period_ticks);
  if (periods.size() > 2) throw RuntimeError(kErrorSyncPeriods, "more than two periods");
  tasks_.push_back(std::move(task));
}

void Interpreter::error(Task& task, int number, const std::string& text) {
  task.status = number;
  cabinet_.log.push_back(task.name + " ends with error " + std::to_string(number) + " at " + text);
}

void Interpreter::fail_task(std::string_view name, int error_number) {
  Task* task = find(name);
  if (task == nullptr) throw std::logic_error("no task of this name to fail");
  error(*task, error_number, "a test's wish");
}

Task* Interpreter::find(std::string_view name) {
  const auto found =
      std::ranges::find_if(tasks_, [&](const Task& task) { return task.name == name && task.status != -1; });
  return found == tasks_.end() ? nullptr : &*found;
}

int Interpreter::task_status(std::string_view name) const {
  const auto found = std::ranges::find_if(tasks_, [&](const Task& task) { return task.name == name; });
  return found == tasks_.end() ? -1 : found->status;
}

std::vector<std::string> Interpreter::tasks() const {
  std::vector<std::string> names;
  for (const Task& task : tasks_)
    if (task.status != -1) names.push_back(task.name);
  return names;
}

bool Interpreter::truth(Task& task, const Expression& e) {
  const Value value = state_of(cabinet_, evaluate(task, e));
  if (!std::holds_alternative<bool>(value)) throw RuntimeError(kErrorInterpreter, "no bool");
  return std::get<bool>(value);
}
double Interpreter::number(Task& task, const Expression& e) {
  const Value value = evaluate(task, e);
  if (!std::holds_alternative<double>(value)) throw RuntimeError(kErrorInterpreter, "no num");
  return std::get<double>(value);
}
std::string Interpreter::text(Task& task, const Expression& e) {
  const Value value = evaluate(task, e);
  if (!std::holds_alternative<std::string>(value)) throw RuntimeError(kErrorInterpreter, "no string");
  return std::get<std::string>(value);
}

Place Interpreter::place(Task& task, const Expression& e) {
  const Activation& here = task.stack.back();
  Place result;
  if (const auto found = here.names.find(e.text); found != here.names.end())
    result = found->second;
  else if (const auto global = application_.globals.find(e.text); global != application_.globals.end())
    result = global->second.place;
  else
    throw RuntimeError(80, "nothing is called " + e.text);
  if (!e.parts.empty()) result = result.element(number(task, e.parts[0]));
  result.fields.insert(result.fields.end(), e.fields.begin(), e.fields.end());
  return result;
}

Value Interpreter::evaluate(Task& task, const Expression& e, Type wanted) {
  switch (e.kind) {
    case ExpressionKind::kNumber:
      return e.number;
    case ExpressionKind::kTruth:
      return e.number != 0;
    case ExpressionKind::kText:
      return e.text;
    case ExpressionKind::kInstruction:
      return instruction(task, e);
    case ExpressionKind::kName: {
      static const std::map<std::string, Blend, std::less<>> blends{
          {"off", Blend::kOff}, {"joint", Blend::kJoint}, {"Cartesian", Blend::kCartesian}};
      if (const auto blend = blends.find(e.text); blend != blends.end()) return blend->second;
      return place(task, e).read();
    }
    case ExpressionKind::kUnary:
      if (e.text == "!") return !truth(task, e.parts[0]);
      return -number(task, e.parts[0]);
    case ExpressionKind::kBinary:
      if (e.text == "and") return truth(task, e.parts[0]) && truth(task, e.parts[1]);
      if (e.text == "or") return truth(task, e.parts[0]) || truth(task, e.parts[1]);
      return operate(e.text, state_of(cabinet_, evaluate(task, e.parts[0])),
                     state_of(cabinet_, evaluate(task, e.parts[1])));
    case ExpressionKind::kBraces:
      break;
  }
  Joint six{};
  for (std::size_t i = 0; i < six.size(); ++i) six[i] = number(task, e.parts.at(i));
  if (wanted == Type::kJoint) return six;
  return Trsf{six[0], six[1], six[2], six[3], six[4], six[5]};
}

Value Interpreter::instruction(Task& task, const Expression& e) {
  const Instruction* known = find_instruction(e.text);
  if (known == nullptr) throw RuntimeError(82, "no instruction " + e.text);
  if (!known->run) return task_instruction(task, e);
  cabinet_.caller = &task;
  Call call{.cabinet = cabinet_, .application = application_};
  call.values.resize(e.parts.size());
  call.places.resize(e.parts.size());
  for (std::size_t i = 0; i < e.parts.size(); ++i) {
    const InstructionParameter& parameter = known->parameters.at(i);
    if (parameter.by_reference)
      call.places[i] = place(task, e.parts[i]);
    else if (parameter.types == std::vector<Type>{Type::kBool})
      call.values[i] = truth(task, e.parts[i]);
    else
      call.values[i] = evaluate(task, e.parts[i], parameter.types.front());
  }
  return known->run(call);
}

Value Interpreter::task_instruction(Task& task, const Expression& e) {
  if (e.text == "delay") {
    task.wake_s = cabinet_.clock_s + number(task, e.parts[0]);
    task.waits = true;
    return 0.0;
  }
  if (e.text == "wait" || e.text == "waitEndMove") {
    const bool done =
        e.text == "wait" ? truth(task, e.parts[0]) : cabinet_.is_empty() && cabinet_.is_settled();
    if (!done) throw Blocked{};
    return 0.0;
  }
  if (e.text == "watch") {
    if (!task.watch_until_s) task.watch_until_s = cabinet_.clock_s + number(task, e.parts[1]);
    const bool met = truth(task, e.parts[0]);
    if (!met && cabinet_.clock_s + 1e-9 < *task.watch_until_s) throw Blocked{};
    task.watch_until_s.reset();
    return met;
  }
  Task* other = find(text(task, e.parts[0]));
  if (e.text == "taskStatus") return other == nullptr ? -1.0 : static_cast<double>(other->status);
  if (other == nullptr) {
    if (e.text == "taskKill") return 0.0;
    throw RuntimeError(kErrorNoTask, "no task of this name");
  }
  if (e.text == "taskKill") other->status = -1;
  if (e.text == "taskSuspend") other->status = 0;
  if (e.text == "taskResume") other->status = 1;
  return 0.0;
}

}  // namespace val3
