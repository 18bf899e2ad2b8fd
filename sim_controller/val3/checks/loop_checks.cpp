/// Loops that go round while they wait for something, without letting other tasks run.
#include <algorithm>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"
#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {
namespace {

using Lines = std::vector<Line>;

class LoopChecks {
 public:
  LoopChecks(const CheckSubject& subject, const Program& program) : subject_(subject), program_(program) {
    const ProgramGraph::Node* const node = subject.graph.node_of(program);
    if (node != nullptr && node->is_of_synchronous) quiet_ = QuietChannel::kIsNone;
  }

  void run() {
    const Lines& lines = program_.lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::size_t close = lines[i].close;
      if (close <= i || close >= lines.size()) continue;
      if (lines[i].kind == Line::Kind::kWhile) loop(i, close, lines[i]);
      if (lines[i].kind == Line::Kind::kDo) loop(i, close, lines[close]);
    }
  }

 private:
  void loop(std::size_t open, std::size_t close, const Line& condition) {
    if (condition.expressions.empty() || subject_.graph.waits_itself(subject_.application, condition, quiet_))
      return;
    const std::optional<bool> always = constant_truth(condition.expressions[0]);
    if (always && *always != (condition.kind == Line::Kind::kWhile)) return;  // it goes round once at most
    for (std::size_t i = open + 1; i < close; ++i) {
      const Line& line = program_.lines[i];
      if (line.kind == Line::Kind::kReturn || subject_.graph.waits(subject_.application, line, quiet_))
        return;
    }
    bool depends_on_body = false;
    visit_expressions(condition, [&](const Expression& e) {
      // What a channel gives is another thing each time.
      const bool asks = e.kind == Expression::Kind::kCall && e.reference.instruction != nullptr &&
                        e.reference.instruction->may_yield;
      depends_on_body = depends_on_body || asks || e.is_unknown || changes(open, close, e);
    });
    if (depends_on_body) return;
    subject_.tell(Severity::kWarning, check_rules::kBusyLoop, program_, program_.lines[open],
                  "nothing in this loop waits, and nothing in it ends it");
  }

  /// The body changes what this name of the condition stands for.
  [[nodiscard]] bool changes(std::size_t open, std::size_t close, const Expression& name) const {
    if (name.kind != Expression::Kind::kName) return false;
    const Global* const global = global_of(subject_.application, name);
    const Reference::To to = name.reference.to;
    bool changed = false;
    for (std::size_t i = open + 1; i < close && !changed; ++i) {
      const Line& line = program_.lines[i];
      visit_uses(subject_.application, line, [&](const Expression& used, Use use) {
        const bool is_same = used.reference.to == to && used.reference.index == name.reference.index &&
                             used.reference.library == name.reference.library;
        changed = changed || (is_same && (use == Use::kWrites || use == Use::kPasses));
      });
      if (line.kind != Line::Kind::kCall) continue;
      // A parameter may stand for any variable.
      if (to == Reference::To::kParameter) changed = true;
      const ProgramGraph::Node* const called = subject_.graph.called(subject_.application, line);
      if (global != nullptr && called != nullptr)
        changed = changed || subject_.graph.writes(*called, *global);
    }
    return changed;
  }

  const CheckSubject& subject_;
  const Program& program_;
  QuietChannel quiet_ = QuietChannel::kIsAWait;
};

}  // namespace

void check_loops(const CheckSubject& subject) {
  for (const Program& program : subject.application.programs) LoopChecks(subject, program).run();
}

}  // namespace val3
