// A program's lines as operations.
#include <algorithm>
#include <cmath>

#include "sim_controller/val3/language/instruction_table.hpp"
#include "sim_controller/val3/machine/assignments.hpp"
#include "sim_controller/val3/machine/calls.hpp"
#include "sim_controller/val3/machine/finite.hpp"
#include "sim_controller/val3/machine/tasks.hpp"
#include "sim_controller/val3/program/run_memory.hpp"

namespace val3 {
namespace {

using LKind = Line::Kind;

Flow go_to(const Context& context, std::size_t line) {
  context.here->next = line;
  return Flow::kGo;
}

template <class T>
class SwitchOperation final : public Operation {
 public:
  struct Case {
    std::vector<NodePtr<T>> values;
    std::size_t line;  // behind it
  };
  SwitchOperation(NodePtr<T> selector, std::vector<Case> cases, std::size_t otherwise)
      : selector_(std::move(selector)), cases_(std::move(cases)), otherwise_(otherwise) {}
  Flow run(Context& context) const override {
    const T selected = selector_->get(context);
    for (const Case& one : cases_)
      for (const NodePtr<T>& value : one.values)
        if (value->get(context) == selected) return go_to(context, one.line);
    return go_to(context, otherwise_);
  }

 private:
  NodePtr<T> selector_;
  std::vector<Case> cases_;
  std::size_t otherwise_;
};

/// Whether a loop's counter is not beyond its end.
struct LoopEnd {
  NodePtr<double> last;
  NodePtr<double> step;  // null: 1

  [[nodiscard]] double step_of(Context& context) const { return step ? step->get(context) : 1.0; }
  [[nodiscard]] bool is_inside(Context& context, double counter, double by) const {
    const double end = last->get(context);
    return by < 0 ? counter >= end : counter <= end;
  }
};

/// An expression by itself: its value is dropped.
template <class T>
OperationPtr evaluation(AnyNode any) {
  auto node = NodePtr<T>(static_cast<const Node<T>*>(any.release()));
  return operation([node = std::move(node)](Context& c) {
    (void)node->get(c);
    return Flow::kGo;
  });
}

class LineCompiler {
 public:
  LineCompiler(Compiler& compiler, const Program& program) : compiler_(compiler), program_(program) {}

  OperationPtr operation_of(std::size_t index) {
    const Line& line = program_.lines[index];
    switch (line.kind) {
      case LKind::kAssign:
        return assignment_operation(compiler_, line);
      case LKind::kInstruction:
        return instruction(line.expressions.at(0));
      case LKind::kCall:
        return call_operation(compiler_, program_, line);
      case LKind::kTaskCreate:
      case LKind::kTaskCreateSync:
        return creation_operation(compiler_, program_, line);
      case LKind::kReturn:
      case LKind::kEnd:
        return operation([](Context& c) {
          Task& task = c.task;
          c.tasks.leave(task);
          return task.stack.empty() ? Flow::kEnded : Flow::kGo;
        });
      case LKind::kBreak:
        return operation([to = line.close](Context& c) { return go_to(c, to); });
      case LKind::kSwitch:
        return selection(line, index);
      case LKind::kFor:
      case LKind::kEndFor:
        return counted_loop(line, index);
      default:
        return branch(line, index);
    }
  }

 private:
  /// if, while, do and what ends or continues them.
  OperationPtr branch(const Line& line, std::size_t index) {
    switch (line.kind) {
      case LKind::kIf:
        return operation([condition = truth(line), next = line.next, index](Context& c) {
          if (condition->get(c)) return Flow::kGo;
          c.here->branch_open = next != index;
          return go_to(c, next);
        });
      case LKind::kElseIf:
        return operation([condition = truth(line), next = line.next, close = line.close](Context& c) {
          if (!c.here->branch_open) return go_to(c, close);
          if (!condition->get(c)) return go_to(c, next);
          c.here->branch_open = false;
          return Flow::kGo;
        });
      case LKind::kElse:
        return operation([close = line.close](Context& c) {
          if (!c.here->branch_open) return go_to(c, close);
          c.here->branch_open = false;
          return Flow::kGo;
        });
      case LKind::kEndIf:
        return operation([](Context& c) {
          c.here->branch_open = false;
          return Flow::kGo;
        });
      case LKind::kWhile:
        return operation([condition = truth(line), behind = line.close + 1](Context& c) {
          return condition->get(c) ? Flow::kGo : go_to(c, behind);
        });
      case LKind::kEndWhile:
        return operation([open = line.open](Context& c) { return go_to(c, open); });
      case LKind::kUntil:
        return operation([condition = truth(line), inside = line.open + 1](Context& c) {
          return condition->get(c) ? Flow::kGo : go_to(c, inside);
        });
      case LKind::kCase:
      case LKind::kDefault:  // only by the case before, which has no break
        return operation([close = line.close](Context& c) { return go_to(c, close); });
      default:  // kDo, kEndSwitch
        return operation([](Context&) { return Flow::kGo; });
    }
  }

  NodePtr<bool> truth(const Line& line) { return compiler_.value<bool>(line.expressions.at(0)); }

  OperationPtr counted_loop(const Line& line, std::size_t index) {
    const Line& head = program_.lines[line.open];
    const bool begins = &head == &line;
    LoopEnd end{compiler_.value<double>(head.expressions.at(2)), nullptr};
    if (head.expressions.size() > 3) end.step = compiler_.value<double>(head.expressions[3]);
    auto counter = compiler_.place<double>(head.expressions.at(0));
    if (!begins)
      return operation(
          [counter = std::move(counter), end = std::move(end), inside = line.open + 1](Context& c) {
            const double step = end.step_of(c);
            const double next = demand_finite(counter->at(c) + step);
            const bool goes_on = end.is_inside(c, next, step);
            counter->at(c) = next;
            return goes_on ? go_to(c, inside) : Flow::kGo;
          });
    (void)index;
    return operation([counter = std::move(counter), first = compiler_.value<double>(head.expressions.at(1)),
                      end = std::move(end), behind = line.close + 1](Context& c) {
      const double value = first->get(c);
      counter->at(c) = value;
      return end.is_inside(c, value, end.step_of(c)) ? Flow::kGo : go_to(c, behind);
    });
  }

  /// In s5 a switch has whole numbers, and of equal cases the last one counts (manual 5, page 26).
  bool is_old_switch() const {
    const Version& language = compiler_.instance().application->language;
    return language != Version{} && language < instruction_table::kS6;
  }

  template <class T>
  NodePtr<T> selected(const Expression& e) {
    NodePtr<T> value = compiler_.value<T>(e);
    if constexpr (std::is_same_v<T, double>) {
      if (is_old_switch())
        return lambda_node<double>(
            [value = std::move(value)](Context& c) { return std::round(value->get(c)); });
    }
    return value;
  }

  OperationPtr selection(const Line& line, std::size_t index) {
    const Expression& selector = line.expressions.at(0);
    if (!is_simulated(selector.type.kind))
      compiler_.refuse(selector, "a switch over this type is not simulated");
    return with_type_of(selector.type.kind, [&]<class T>() -> OperationPtr {
      if constexpr (requires(const T& x) { x == x; }) {
        std::vector<typename SwitchOperation<T>::Case> cases;
        std::size_t otherwise = line.close;
        for (std::size_t at = line.next; at != line.close && at > index; at = program_.lines[at].next) {
          const Line& one = program_.lines[at];
          if (one.kind == LKind::kDefault) {
            otherwise = at + 1;
            continue;
          }
          typename SwitchOperation<T>::Case made{{}, at + 1};
          for (const Expression& value : one.expressions) made.values.push_back(selected<T>(value));
          cases.push_back(std::move(made));
        }
        if (is_old_switch()) std::ranges::reverse(cases);
        return std::make_unique<const SwitchOperation<T>>(selected<T>(selector), std::move(cases), otherwise);
      } else {
        compiler_.refuse(selector, "a switch over this type is not simulated");
      }
    });
  }

  OperationPtr instruction(const Expression& e) {
    if (e.kind == Expression::Kind::kCall && e.text == "delay")
      return operation([seconds = compiler_.value<double>(e.parts.at(0)), who = &e](Context& c) {
        // 0 or less passes the turn
        if (c.task.waits_in == who) return c.tasks.is_over(c.task, who, 0.0) ? Flow::kGo : Flow::kWait;
        const double time_s = seconds->get(c);
        if (!std::isfinite(time_s)) throw RunFailure(kErrorParameter, "a delay of no number");
        (void)c.tasks.is_over(c.task, who, std::max(0.0, time_s));
        c.task.waits_in = who;
        return Flow::kWait;
      });
    if (e.kind == Expression::Kind::kCall && e.text == "wait")
      return operation([condition = compiler_.value<bool>(e.parts.at(0))](Context& c) {
        return condition->get(c) ? Flow::kGo : Flow::kWait;
      });
    if (e.type.kind == Kind::kVoid) return evaluation<Nothing>(compiler_.any(e));
    if (!is_simulated(e.type.kind)) compiler_.refuse_type(e, "values of this type are not simulated");
    return with_type_of(e.type.kind,
                        [&]<class T>() -> OperationPtr { return evaluation<T>(compiler_.any(e)); });
  }

  Compiler& compiler_;
  const Program& program_;
};

}  // namespace

Code compile(const Instance& instance, const Fathers& fathers, const Program& program, Findings& findings) {
  Code code{.program = &program,
            .instance = &instance,
            .call_bytes = bytes_of_call(*instance.application, program)};
  Compiler compiler(instance, fathers, program);
  LineCompiler lines(compiler, program);
  for (std::size_t i = 0; i < program.lines.size(); ++i) {
    try {
      code.operations.push_back(lines.operation_of(i));
    } catch (const NotSimulated& refused) {
      findings.push_back({.severity = Severity::kError,
                          .rule = "not-simulated",
                          .at = refused.at,
                          .what = refused.what,
                          .remedy = refused.remedy});
      code.operations.push_back(operation([](Context&) { return Flow::kGo; }));
    }
  }
  return code;
}

}  // namespace val3
