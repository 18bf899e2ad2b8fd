/// What a manual warns of: it runs, and does something else than it seems to say.
#include <algorithm>
#include <array>
#include <unordered_set>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"

namespace val3 {
namespace {

/// Their results are rarely the number that they seem to be.
constexpr std::array<std::string_view, 8> kInexact{"sin",  "cos",  "tan",  "asin",
                                                   "acos", "atan", "sqrt", "exp"};

bool is_call(const Expression& e, std::string_view name) {
  return e.kind == Expression::Kind::kCall && e.text == name;
}
bool is_joint(const Expression& e) {
  return !e.is_unknown && (e.type.kind == Kind::kJoint || e.type.kind == Kind::kJointRs);
}

class TrapChecks {
 public:
  explicit TrapChecks(const CheckSubject& subject) : subject_(subject) {}

  void run() {
    for (const Program& program : subject_.application.programs)
      for (const Line& line : program.lines) {
        visit_expressions(line, [&](const Expression& e) { expression(program, e); });
        collect_blend(program, line);
      }
    if (has_latch_) tell_blends();
  }

 private:
  void expression(const Program& program, const Expression& e) {
    if (e.kind == Expression::Kind::kUnary && e.text == "!" && is_joint_comparison(e.parts[0]))
      subject_.tell(Severity::kNote, check_rules::kJointComparison, program, e,
                    "not every axis above is not the same as some axis below");
    if (e.kind == Expression::Kind::kBinary && (e.text == "==" || e.text == "!="))
      for (const Expression& side : e.parts)
        if (side.kind == Expression::Kind::kCall && std::ranges::find(kInexact, side.text) != kInexact.end())
          subject_.tell(Severity::kNote, check_rules::kExactComparison, program, e,
                        "the result of " + side.text + "() is compared to the last digit",
                        "compare the difference with a small number");
    if (is_call(e, "sioCtrl") && e.parts.size() == 3 && e.parts[1].text == "timeout" &&
        constant_of(e.parts[2]) == 0.0)
      subject_.tell(Severity::kNote, check_rules::kTimeoutZero, program, e,
                    "a time-out of 0 is none: a read waits until something comes");
  }

  static bool is_joint_comparison(const Expression& e) {
    return e.kind == Expression::Kind::kBinary && (e.text == "<" || e.text == ">") && is_joint(e.parts[0]);
  }

  struct LineMove {
    const Program* program = nullptr;
    const Expression* at = nullptr;
    const Global* descriptor = nullptr;
  };

  void collect_blend(const Program& program, const Line& line) {
    visit_expressions(line, [&](const Expression& e) {
      if (is_call(e, "setLatch")) has_latch_ = true;
      if (is_call(e, "movel") && e.parts.size() == 3)
        if (const Global* const descriptor = global_of(subject_.application, root_of(e.parts[2])))
          moves_.push_back({&program, &e, descriptor});
    });
    if (line.kind != Line::Kind::kAssign) return;
    const Expression& place = line.expressions[0];
    const bool is_blend = place.kind == Expression::Kind::kField && place.text == "blend";
    // One that is assigned as a whole is another's, or in braces.
    if (is_blend || place.type.kind == Kind::kMdesc)
      set_.insert(global_of(subject_.application, root_of(place)));
  }

  void tell_blends() {
    for (const LineMove& move : moves_) {
      if (set_.contains(move.descriptor)) continue;
      const auto& values = move.descriptor->values;
      const bool is_off = !values.empty() && std::ranges::all_of(values, [](const StoredValue& value) {
        const auto blend = value.attributes.find("blend");
        return blend != value.attributes.end() && blend->second == "off";
      });
      if (!is_off && set_.insert(move.descriptor).second)
        subject_.tell(Severity::kNote, check_rules::kBlend, *move.program, *move.at,
                      move.descriptor->declared.name + " blends, in an application that waits for a contact",
                      "set its blend to off");
    }
  }

  const CheckSubject& subject_;
  bool has_latch_ = false;
  std::vector<LineMove> moves_;
  std::unordered_set<const Global*> set_;
};

}  // namespace

void check_traps(const CheckSubject& subject) { TrapChecks(subject).run(); }

}  // namespace val3
