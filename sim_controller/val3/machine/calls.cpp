// Programs that are called, and tasks that are made of them.
#include "sim_controller/val3/machine/calls.hpp"

#include <cmath>

#include "sim_controller/val3/machine/libraries.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

using CalledKind = Line::Kind;

constexpr double kTickSecondsOfTasks = 0.004;
constexpr double kPriorityMax = 100.0;
/// Locals of a call are made anew: about so many bytes of run memory a value.
constexpr std::size_t kBytesOfAValue = 8;

/// Fills a parameter of the program that is called.
class Hand {
 public:
  Hand() = default;
  virtual ~Hand() = default;
  Hand(const Hand&) = delete;
  Hand& operator=(const Hand&) = delete;
  virtual void over(Context& caller, Activation& called, std::size_t slot) const = 0;
};
class HandPlace final : public Hand {
 public:
  explicit HandPlace(RefNodePtr ref) : ref_(std::move(ref)) {}
  void over(Context& caller, Activation& called, std::size_t slot) const override {
    called.slots[slot] = ref_->get(caller);
  }

 private:
  RefNodePtr ref_;
};
template <class T>
class HandValue final : public Hand {
 public:
  explicit HandValue(NodePtr<T> value) : value_(std::move(value)) {}
  void over(Context& caller, Activation& called, std::size_t slot) const override {
    T& parameter = called.slots[slot].at<T>();
    parameter = value_->get(caller);
    if constexpr (std::is_same_v<T, Record>) caller.tasks.charge(2 * parameter.values());
  }

 private:
  NodePtr<T> value_;
};
using Hands = std::vector<std::unique_ptr<const Hand>>;

class CallCompiler {
 public:
  CallCompiler(Compiler& compiler, const Program& program) : compiler_(compiler), program_(program) {}

  OperationPtr call(const Line& line) {
    Called code = called_by(line);
    return operation([code, made = hands(*code.declared->program, line, 0)](Context& c) {
      auto called = Tasks::activate(code.get(), c.tasks.fathers);
      c.tasks.charge(called->code->call_bytes / kBytesOfAValue);
      for (std::size_t i = 0; i < made.size(); ++i) made[i]->over(c, *called, i);
      c.tasks.enter(c.task, std::move(called));
      return Flow::kGo;
    });
  }

  OperationPtr creation(const Line& line) {
    const bool is_sync = line.kind == CalledKind::kTaskCreateSync;
    Called code = called_by(line);
    auto name = compiler_.value<std::string>(line.expressions.at(0));
    auto second = compiler_.value<double>(line.expressions.at(1));
    RefNodePtr overrun;
    if (is_sync) overrun = compiler_.ref(line.expressions.at(2));
    auto made = hands(*code.declared->program, line, is_sync ? 3 : 2);
    return operation([code, name = std::move(name), second = std::move(second), overrun = std::move(overrun),
                      made = std::move(made), owner = &compiler_.instance()](Context& c) {
      auto task = std::make_unique<Task>();
      task->name = name->get(c);
      task->owner = owner;
      const double number = second->get(c);
      if (overrun) {
        task->period_ticks = period_in_ticks(number);
        tell_rounding(c, task->name, number, task->period_ticks);
        task->overrun = overrun->get(c);
      } else {
        if (number < 1.0 || number > kPriorityMax)
          throw RunFailure(kErrorParameter, "a priority that is not from 1 to 100");
        task->priority = static_cast<int>(number);
      }
      auto called = Tasks::activate(code.get(), c.tasks.fathers);
      c.tasks.charge(called->code->call_bytes / kBytesOfAValue);
      for (std::size_t i = 0; i < made.size(); ++i) made[i]->over(c, *called, i);
      c.tasks.enter(*task, std::move(called));
      c.tasks.create(std::move(task));
      return Flow::kGo;
    });
  }

 private:
  /// The program of a line; that of a library may change while the application runs.
  struct Called {
    const Code* declared = nullptr;
    const LibrarySlot* slot = nullptr;
    int program = -1;

    [[nodiscard]] const Code& get() const {
      return slot == nullptr ? *declared : loaded_program(*slot, program);
    }
  };

  Called called_by(const Line& line) {
    const Instance* owner = &compiler_.instance();
    const LibrarySlot* slot = nullptr;
    if (line.called_library >= 0) {
      slot = owner->slots.at(static_cast<std::size_t>(line.called_library)).get();
      owner = slot->declared;
    }
    if (owner == nullptr || line.called_program < 0)
      throw NotSimulated{.at = {program_.file, line.line, line.column},
                         .what = "program " + line.program + " is of a library that is not there",
                         .remedy = "put its folder beside the application"};
    return {.declared = &owner->programs.at(static_cast<std::size_t>(line.called_program)),
            .slot = slot == nullptr || slot->is_fixed ? nullptr : slot,
            .program = line.called_program};
  }

  Hands hands(const Program& called, const Line& line, std::size_t first) {
    Hands made;
    for (std::size_t i = 0; i < called.parameters.size(); ++i) {
      const Parameter& parameter = called.parameters[i];
      const Expression& argument = line.expressions.at(first + i);
      if (parameter.by_reference) {
        const Kind given = argument.type.kind;
        if (given != Kind::kVoid && given != parameter.type.kind)
          compiler_.refuse(argument, "a reference to a variable of another type");
        made.push_back(std::make_unique<const HandPlace>(compiler_.ref(argument)));
        continue;
      }
      if (!is_simulated(parameter.type.kind))
        compiler_.refuse_type(argument, "values of this type are not simulated");
      made.push_back(with_type_of(parameter.type.kind, [&]<class T>() -> std::unique_ptr<const Hand> {
        return std::make_unique<const HandValue<T>>(compiler_.value<T>(argument));
      }));
    }
    return made;
  }

  /// Rounded down to a multiple of 4 ms (manual 6, page 88).
  static int period_in_ticks(double period_s) {
    constexpr double kSlack = 1e-9;
    constexpr double kTicksMax = 1e6;
    const double ticks = std::floor(period_s / kTickSecondsOfTasks + kSlack);
    if (!(ticks >= 1.0) || ticks > kTicksMax) throw RunFailure(kErrorPeriods, "a period below 4 ms");
    return static_cast<int>(ticks);
  }

  static void tell_rounding(Context& context, const std::string& name, double period_s, int ticks) {
    constexpr double kSame = 1e-9;
    const double taken_s = ticks * kTickSecondsOfTasks;
    if (std::abs(period_s - taken_s) > kSame)
      context.system.log("the period of " + name + ", " + std::to_string(period_s) +
                         " s, is rounded down to " + std::to_string(taken_s) + " s");
  }

  Compiler& compiler_;
  const Program& program_;
};

}  // namespace

OperationPtr call_operation(Compiler& compiler, const Program& program, const Line& line) {
  return CallCompiler(compiler, program).call(line);
}

OperationPtr creation_operation(Compiler& compiler, const Program& program, const Line& line) {
  return CallCompiler(compiler, program).creation(line);
}

}  // namespace val3
