/// Synchronous tasks (manual 6, pages 81 and 88).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <unordered_set>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"
#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {
namespace {

constexpr double kControllerPeriod_s = 0.004;
constexpr double kShortPeriod_s = 0.002;  // s8 has controllers with this one
constexpr std::size_t kPeriodsAtOnceMax = 2;

std::string period_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g s", seconds);
  return text;
}

/// A move waits only while the store of moves is full.
bool is_move(std::string_view name) {
  return name.starts_with("move") || name.starts_with("alterMove") || name.starts_with("$move");
}
/// Tested once a period: the task skips what it has no time for, as was meant.
bool is_timed_wait(std::string_view name) { return name == "wait" || name == "watch" || name == "delay"; }

class TaskChecks {
 public:
  explicit TaskChecks(const CheckSubject& subject) : subject_(subject) {}

  void run() {
    for (const Program& program : subject_.application.programs)
      for (const Line& line : program.lines)
        if (line.kind == Line::Kind::kTaskCreateSync && line.expressions.size() >= 3) task(program, line);
  }

 private:
  void task(const Program& program, const Line& line) {
    period(program, line);
    const ProgramGraph::Node* const first = subject_.graph.called(subject_.application, line);
    if (first == nullptr) return;
    const Expression& name = line.expressions[0];
    const std::string who = name.kind == Expression::Kind::kText ? "the synchronous task " + name.text
                                                                 : "a synchronous task of " + line.program;
    for (const ProgramGraph::Node* const node : subject_.graph.reached(*first))
      for (const Line& one : node->program->lines)
        if (told_.insert(&one).second) line_of_task(*node, one, who);
  }

  void line_of_task(const ProgramGraph::Node& node, const Line& line, const std::string& who) {
    visit_expressions(line, [&](const Expression& e) {
      if (e.kind == Expression::Kind::kCall && e.reference.instruction != nullptr) call(node, e, who);
    });
    if (!uses_channel(line)) return;
    const auto channel = std::ranges::find_if(
        line.expressions, [](const Expression& e) { return e.type.kind == Kind::kSio && !e.is_unknown; });
    if (subject_.graph.quiet_channels().contains(*node.application, *channel)) return;
    subject_.tell(Severity::kWarning, check_rules::kSyncBlocking, *node.program, line,
                  "a channel is read or written by =, which may wait, in " + who);
  }

  void call(const ProgramGraph::Node& node, const Expression& e, const std::string& who) {
    const Instruction& called = *e.reference.instruction;
    if ((!called.may_block && !called.may_yield) || is_move(e.text)) return;
    if (is_timed_wait(e.text)) {
      const bool passes_turn = e.text == "delay" && constant_of(e.parts[0]).value_or(1.0) <= 0.0;
      if (!passes_turn)
        subject_.tell(Severity::kNote, check_rules::kSyncWait, *node.program, e,
                      e.text + "() lets periods pass, in " + who);
      return;
    }
    const bool is_channel = e.text == "sioGet" || e.text == "sioSet";
    if (is_channel && subject_.graph.quiet_channels().contains(*node.application, e.parts[0])) return;
    subject_.tell(
        Severity::kWarning, check_rules::kSyncBlocking, *node.program, e, e.text + "() may wait, in " + who,
        is_channel ? "set its time-out to -1 by sioCtrl, or use the channel in an asynchronous task" : "");
  }

  void period(const Program& program, const Line& line) {
    const Expression& e = line.expressions[1];
    if (const std::optional<double> seconds = constant_of(e)) return one_period(program, e, *seconds);
    for (const double seconds : constants_in(program, e)) one_period(program, e, seconds);
  }

  /// The constants that a variable is set to: a local in its program, a global anywhere, or in the data.
  std::set<double> constants_in(const Program& program, const Expression& name) const {
    std::set<double> found;
    if (name.kind != Expression::Kind::kName) return found;
    const Global* const global = global_of(subject_.application, name);
    const bool is_local = name.reference.to == Reference::To::kLocal;
    for (const ProgramGraph::Node& node : subject_.graph.nodes()) {
      if (global == nullptr && !(is_local && node.program == &program)) continue;
      for (const Line& line : node.program->lines) {
        if (line.kind != Line::Kind::kAssign) continue;
        const std::optional<double> value = constant_of(line.expressions.back());
        const Expression& place = line.expressions.front();
        const bool is_same = global != nullptr ? global_of(*node.application, place) == global
                                               : place.reference.to == Reference::To::kLocal &&
                                                     place.reference.index == name.reference.index;
        if (value && is_same) found.insert(*value);
      }
    }
    return found;
  }

  void one_period(const Program& program, const Expression& e, double seconds) {
    const double unit =
        subject_.application.language >= Version{8, 0, 0} ? kShortPeriod_s : kControllerPeriod_s;
    const double periods = seconds / unit;
    const double whole = std::floor(periods + 1e-6);
    if (!std::isfinite(periods) || whole < 1.0 || std::abs(periods - whole) > 1e-6)
      subject_.tell(Severity::kWarning, check_rules::kSyncPeriod, program, e,
                    "a period of " + period_text(seconds) + " is no multiple of " + period_text(unit) +
                        (whole >= 1.0 ? ": it becomes " + period_text(whole * unit) : ""));
    if (periods_.insert(whole).second && periods_.size() > kPeriodsAtOnceMax)
      subject_.tell(Severity::kWarning, check_rules::kSyncPeriods, program, e,
                    std::to_string(periods_.size()) +
                        " different periods in this application: a third at the same time is error 32");
  }

  const CheckSubject& subject_;
  std::unordered_set<const Line*> told_;
  std::set<double> periods_;
};

}  // namespace

void check_tasks(const CheckSubject& subject) { TaskChecks(subject).run(); }

}  // namespace val3
