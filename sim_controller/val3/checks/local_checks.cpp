/// Locals and parameters: read before they are set, never used.
#include <algorithm>
#include <limits>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"

namespace val3 {
namespace {

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

struct LocalUse {
  std::size_t first_read = kNowhere;   // line in which its value is read for the first time
  std::size_t first_write = kNowhere;  // line behind which it has been set
  std::vector<std::size_t> writes;
  bool is_used = false;
  const Expression* read = nullptr;
};

class LocalChecks {
 public:
  LocalChecks(const CheckSubject& subject, const Program& program)
      : subject_(subject),
        program_(program),
        locals_(program.locals.size()),
        parameters_(program.parameters.size(), false) {}

  void run() {
    for (std::size_t i = 0; i < program_.lines.size(); ++i)
      visit_uses(subject_.application, program_.lines[i],
                 [&](const Expression& name, Use use) { add(i, name, use); });
    for (std::size_t i = 0; i < locals_.size(); ++i) tell_local(program_.locals[i], locals_[i]);
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      if (!parameters_[i])
        subject_.tell(Severity::kNote, check_rules::kUnusedParameter, program_.file,
                      program_.parameters[i].line, 0, program_.parameters[i].name + " is never used");
  }

 private:
  void add(std::size_t line, const Expression& name, Use use) {
    const auto index = static_cast<std::size_t>(name.reference.index);
    if (name.reference.to == Reference::To::kParameter && index < parameters_.size())
      parameters_[index] = true;
    if (name.reference.to != Reference::To::kLocal || index >= locals_.size()) return;
    LocalUse& local = locals_[index];
    local.is_used = true;
    if (use == Use::kWrites || use == Use::kPasses) {
      local.first_write = std::min(local.first_write, line);
      local.writes.push_back(line);
    } else if (use == Use::kReads && local.first_write == kNowhere && local.first_read == kNowhere) {
      local.first_read = line;
      local.read = &name;
    }
  }

  /// Some loop goes round both lines: what is set in the one is read in the other the next time.
  [[nodiscard]] bool in_one_loop(std::size_t first, std::size_t second) const {
    for (std::size_t i = 0; i <= first; ++i) {
      const Line& line = program_.lines[i];
      const bool is_loop =
          line.kind == Line::Kind::kWhile || line.kind == Line::Kind::kDo || line.kind == Line::Kind::kFor;
      if (is_loop && line.close >= second) return true;
    }
    return false;
  }

  void tell_local(const Declaration& declared, const LocalUse& local) {
    if (!local.is_used)
      return subject_.tell(Severity::kNote, check_rules::kUnusedVariable, declared.file, declared.line, 0,
                           "the local " + declared.name + " is never used");
    if (local.read == nullptr) return;
    for (const std::size_t write : local.writes)
      if (in_one_loop(local.first_read, write)) return;
    subject_.tell(Severity::kWarning, check_rules::kLocalNeverSet, program_, *local.read,
                  local.writes.empty() ? declared.name + " is read and never set"
                                       : declared.name + " is read here before it is set");
  }

  const CheckSubject& subject_;
  const Program& program_;
  std::vector<LocalUse> locals_;
  std::vector<bool> parameters_;
};

}  // namespace

void check_locals(const CheckSubject& subject) {
  for (const Program& program : subject.application.programs) LocalChecks(subject, program).run();
}

}  // namespace val3
