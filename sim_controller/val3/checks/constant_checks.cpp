/// Mistakes that are written out: they fail whenever their line is reached.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"
#include "sim_controller/val3/program/run_memory.hpp"
#include "sim_controller/val3/program/signal_link.hpp"

namespace val3 {
namespace {

using ConstantPart = Expression::Kind;

bool is_signal(const Expression& e) {
  return !e.is_unknown && (e.type.kind == Kind::kDio || e.type.kind == Kind::kAio);
}

const std::string* link_of(const StoredValue& value) {
  const auto link = value.attributes.find("link");
  return link == value.attributes.end() || link->second.empty() ? nullptr : &link->second;
}

class ConstantChecks {
 public:
  explicit ConstantChecks(const CheckSubject& subject) : subject_(subject) {}

  void run() {
    for (const ProgramGraph::Node& node : subject_.graph.nodes())
      for (const Line& line : node.program->lines) collect_changes(node, line);
    for (const Program& program : subject_.application.programs) {
      for (const Line& line : program.lines) {
        visit_expressions(line, [&](const Expression& e) { expression(program, e); });
        if (line.kind == Line::Kind::kAssign) assignment(program, line);
      }
      recursion(program);
      run_memory(program);
    }
  }

 private:
  // ---- what may change while the application runs ----

  void collect_changes(const ProgramGraph::Node& node, const Line& line) {
    const Application& application = *node.application;
    visit_expressions(line, [&](const Expression& e) {
      if (e.kind != ConstantPart::kCall || e.parts.empty()) return;
      const bool resizes = e.text == "resize" || e.text == "append" || e.text == "insert" ||
                           e.text == "delete" || e.text == "libList";
      const bool links = e.text == "dioLink" || e.text == "aioLink";
      for (const Expression& part : e.parts) {
        if (resizes || e.text.starts_with('$'))
          resized_.insert(declared_of(application, *node.program, root_of(part)));
        if (links) linked_.insert(global_of(application, root_of(part)));
      }
    });
    visit_uses(application, line, [&](const Expression& name, Use use) {
      if (use != Use::kPasses) return;
      linked_.insert(global_of(application, name));
      resized_.insert(declared_of(application, *node.program, name));
    });
  }

  // ---- expressions ----

  void expression(const Program& program, const Expression& e) {
    if (e.kind == ConstantPart::kIndex && !e.is_unknown) index(program, e);
    if (e.kind == ConstantPart::kBinary && (e.text == "/" || e.text == "%") && constant_of(e.parts[1]) == 0.0)
      subject_.tell(Severity::kWarning, check_rules::kDivisionByZero, program, e,
                    "a division by 0: error 10");
    if (e.kind != ConstantPart::kCall || e.parts.empty()) return;
    if (e.text == "size" && e.parts.size() == 2) dimension(program, e);
    if ((e.text == "dioSet" || e.text == "aioSet") && is_signal(e.parts[0])) written(program, e.parts[0], e);
  }

  void index(const Program& program, const Expression& e) {
    const Declaration* const declared = declared_of(subject_.application, program, e.parts[0]);
    // What stands behind a library's alias may be another project by then, with data of other sizes.
    const bool keeps_size = declared != nullptr && !resized_.contains(declared) &&
                            e.parts[0].reference.library < 0 && declared->sizes.size() == e.parts.size() - 1;
    for (std::size_t i = 1; i < e.parts.size(); ++i) {
      const auto given = constant_of(e.parts[i]);
      if (!given) continue;
      const double at = std::trunc(*given);
      if (at < 0.0)
        subject_.tell(Severity::kWarning, check_rules::kConstantIndex, program, e,
                      "a negative index: error 21");
      else if (keeps_size && at >= static_cast<double>(declared->sizes[i - 1]))
        subject_.tell(Severity::kWarning, check_rules::kConstantIndex, program, e,
                      declared->name + " has " + std::to_string(declared->sizes[i - 1]) +
                          " elements, counted from 0: error 20");
    }
  }

  void dimension(const Program& program, const Expression& e) {
    const Declaration* const declared = declared_of(subject_.application, program, e.parts[0]);
    const auto given = constant_of(e.parts[1]);
    if (declared == nullptr || declared->is_collection() || !given) return;
    if (*given >= 1.0 && *given < static_cast<double>(declared->sizes.size()) + 1.0) return;
    subject_.tell(Severity::kWarning, check_rules::kConstantIndex, program, e,
                  declared->name + " has " + std::to_string(declared->sizes.size()) +
                      (declared->sizes.size() == 1 ? " dimension" : " dimensions") + ", counted from 1");
  }

  /// Of a local or a global; null where the sizes are not known: those of a field are its variable's own.
  [[nodiscard]] static const Declaration* declared_of(const Application& application, const Program& program,
                                                      const Expression& e) {
    if (e.is_unknown) return nullptr;
    if (e.reference.to == Reference::To::kLocal)
      return &program.locals[static_cast<std::size_t>(e.reference.index)];
    const Global* const global = global_of(application, e);
    return global == nullptr ? nullptr : &global->declared;
  }

  // ---- what cannot be written ----

  void assignment(const Program& program, const Line& line) {
    for (std::size_t i = 0; i + 1 < line.expressions.size(); ++i) {
      const Expression& place = line.expressions[i];
      if (is_signal(place)) written(program, place, place);
      const Reference::To to = root_of(place).reference.to;
      if (to == Reference::To::kWorld || to == Reference::To::kFlange)
        subject_.tell(Severity::kWarning, check_rules::kFixedFrame, program, place,
                      root_of(place).text +
                          " is changed: the next line that computes with it ends with error " +
                          (to == Reference::To::kWorld ? "161" : "160"));
    }
  }

  /// An output is written; told where its link, or that of each element that it may be, is an input's.
  void written(const Program& program, const Expression& place, const Expression& at) {
    const Global* const global = global_of(subject_.application, root_of(place));
    if (global == nullptr || global->values.empty()) return;
    std::optional<double> element = 0.0;
    if (place.kind == ConstantPart::kIndex && place.parts.size() == 2) element = constant_of(place.parts[1]);
    const std::string* input = nullptr;
    for (const StoredValue& value : global->values) {
      const bool may_be_it =
          !element || (value.index.size() == 1 && static_cast<double>(value.index[0]) == *element);
      if (!may_be_it) continue;
      const std::string* const link = link_of(value);
      if (link == nullptr || !names_input(*link)) return;
      input = link;
    }
    if (input == nullptr) return;
    const bool is_certain = !linked_.contains(global);
    subject_.tell(is_certain ? Severity::kWarning : Severity::kNote, check_rules::kWriteToInput, program, at,
                  global->declared.name + " is linked to the input " + *input + ", and written: error 122");
  }

  // ---- run memory ----

  /// A call of the program by itself that nothing decides about.
  void recursion(const Program& program) {
    int conditions = 0;
    for (const Line& line : program.lines) {
      switch (line.kind) {
        case Line::Kind::kIf:
        case Line::Kind::kFor:
        case Line::Kind::kSwitch:
        case Line::Kind::kWhile:
          ++conditions;
          break;
        case Line::Kind::kEndIf:
        case Line::Kind::kEndFor:
        case Line::Kind::kEndSwitch:
        case Line::Kind::kEndWhile:
          --conditions;
          break;
        case Line::Kind::kReturn:
          return;
        case Line::Kind::kCall:
          if (called_program(subject_.application, line) == &program) {
            tell_recursion(program, line, conditions == 0);
            return;
          }
          break;
        default:
          break;
      }
    }
  }

  void tell_recursion(const Program& program, const Line& line, bool is_certain) {
    if (is_certain)
      subject_.tell(Severity::kWarning, check_rules::kEndlessRecursion, program, line,
                    program.name + " calls itself, and nothing decides about it: error 41");
    else if (program.name == "start")
      subject_.tell(Severity::kNote, check_rules::kEndlessRecursion, program, line,
                    "start() calls itself, which begins nothing anew: the first call goes on after it");
  }

  /// A library's programs run in the memory of whoever creates the task.
  void run_memory(const Program& program) {
    if (subject_.application.program_named("start") < 0) return;
    const std::size_t memory = run_memory_of(subject_.application);
    const std::size_t wanted = bytes_of_call(subject_.application, program);
    if (program.name == "start" && subject_.application.stack_bytes == 0)
      subject_.tell(Severity::kNote, check_rules::kRunMemory, subject_.application.project, 0, 0,
                    "stackSize is 0: it is taken as " + std::to_string(memory) + " here",
                    "write 5000, which is usual");
    if (wanted > memory)
      subject_.tell(Severity::kWarning, check_rules::kRunMemory, program.file, program.line, 0,
                    program.name + " takes at least " + std::to_string(wanted) +
                        " bytes of run memory by itself, and stackSize is " + std::to_string(memory));
  }

  const CheckSubject& subject_;
  std::unordered_set<const Declaration*> resized_;
  std::unordered_set<const Global*> linked_;
};

}  // namespace

void check_constants(const CheckSubject& subject) { ConstantChecks(subject).run(); }

}  // namespace val3
