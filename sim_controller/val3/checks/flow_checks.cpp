/// Lines that are never reached.
#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"

namespace val3 {
namespace {

constexpr int kBlocksDeepMax = 200;  // deeper ones are taken as reached

class Flow {
 public:
  Flow(const CheckSubject& subject, const Program& program)
      : subject_(subject), program_(program), lines_(program.lines) {}

  void run() { sequence(0, lines_.size(), true); }

 private:
  /// Whether what stands behind these lines is reached through them. `entered`: whether the first of them is.
  bool sequence(std::size_t first, std::size_t end, bool entered) {
    if (++depth_ > kBlocksDeepMax) {
      --depth_;
      return true;
    }
    bool reached = entered, told = false;
    std::size_t i = first;
    while (i < end) {
      const Line& line = lines_[i];
      // `break` must end a case and `end` a program, whatever stands before them.
      const bool may_be_idle = line.kind == Line::Kind::kBreak || line.kind == Line::Kind::kEnd;
      if (!reached && !told && !may_be_idle) {
        told = true;
        subject_.tell(Severity::kWarning, check_rules::kUnreachable, program_, line,
                      "this line is never reached");
      }
      const std::size_t close = line.open == i && line.close > i && line.close < end ? line.close : i;
      const bool goes_on = close > i ? block(i, close, reached) : simple(line, reached);
      reached = reached && goes_on;
      i = close + 1;
    }
    --depth_;
    return reached;
  }

  bool simple(const Line& line, bool reached) {
    if (line.kind == Line::Kind::kBreak) {
      breaks_ = breaks_ || reached;
      return false;
    }
    return line.kind != Line::Kind::kReturn;
  }

  /// Inside of a block that is not reached nothing more is told.
  bool block(std::size_t open, std::size_t close, bool reached) {
    switch (lines_[open].kind) {
      case Line::Kind::kIf:
        return branches(open, close, Line::Kind::kElse, reached);
      case Line::Kind::kSwitch: {
        const bool outer = breaks_;
        breaks_ = false;
        const bool falls = branches(open, close, Line::Kind::kDefault, reached);
        const bool goes_on = falls || breaks_;
        breaks_ = outer;
        return goes_on;
      }
      case Line::Kind::kWhile:
        sequence(open + 1, close, !reached || !is_always(lines_[open], false));
        return !is_always(lines_[open], true);
      case Line::Kind::kDo: {
        const bool through = sequence(open + 1, close, true);
        return through && !is_always(lines_[close], false);
      }
      default:
        sequence(open + 1, close, true);
        return true;
    }
  }

  /// Of `if` and `switch`; behind them is reached through a branch, or where none need be taken.
  bool branches(std::size_t open, std::size_t close, Line::Kind last, bool reached) {
    bool goes_on = false, has_last = false;
    std::size_t at = open;
    while (at < close) {
      const std::size_t next = lines_[at].next > at && lines_[at].next <= close ? lines_[at].next : close;
      // Before its first case a switch has nothing.
      const bool is_head = at == open && lines_[open].kind == Line::Kind::kSwitch;
      const bool is_condition = lines_[at].kind == Line::Kind::kIf || lines_[at].kind == Line::Kind::kElseIf;
      const bool entered = !reached || !is_condition || !is_always(lines_[at], false);
      if (sequence(at + 1, next, entered) && !is_head) goes_on = true;
      has_last = has_last || lines_[at].kind == last;
      at = next;
    }
    return goes_on || !has_last;
  }

  static bool is_always(const Line& condition, bool truth) {
    return condition.expressions.size() == 1 && constant_truth(condition.expressions[0]) == truth;
  }

  const CheckSubject& subject_;
  const Program& program_;
  const std::vector<Line>& lines_;
  bool breaks_ = false;
  int depth_ = 0;
};

}  // namespace

void check_flow(const CheckSubject& subject) {
  for (const Program& program : subject.application.programs) Flow(subject, program).run();
}

}  // namespace val3
