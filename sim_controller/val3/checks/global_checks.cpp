/// Variables of the application that are never set, linked or used, and programs that nothing calls.
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"

namespace val3 {
namespace {

bool stores_something(const std::vector<StoredValue>& values) {
  return std::ranges::any_of(
      values, [](const StoredValue& value) { return !value.attributes.empty() || !value.fields.empty(); });
}

class GlobalChecks {
 public:
  explicit GlobalChecks(const CheckSubject& subject) : subject_(subject) {}

  void run() {
    for (const ProgramGraph::Node& node : subject_.graph.nodes())
      for (const Line& line : node.program->lines) {
        visit_uses(*node.application, line,
                   [&](const Expression& name, Use use) { add(*node.application, name, use); });
        if (const Program* const called = called_program(*node.application, line))
          if (called != node.program) called_.insert(called);
      }
    for (const Global& global : subject_.application.globals) named_.emplace(global.declared.name, &global);
    for (const Global& global : subject_.application.globals) add_fathers(global.values);
    for (const Global& global : subject_.application.globals)
      if (!global.is_public) tell_global(global);
    for (const Program& program : subject_.application.programs)
      if (!program.is_public && program.name != "start" && program.name != "stop" &&
          !called_.contains(&program))
        subject_.tell(Severity::kNote, check_rules::kUnusedProgram, program.file, program.line, 0,
                      "nothing calls the program " + program.name +
                          (subject_.application.has_pages ? ", but perhaps a user page does" : ""),
                      subject_.application.has_pages ? "look for it in the files of interface/" : "");
  }

 private:
  struct Uses {
    bool is_written = false;
  };

  void add(const Application& application, const Expression& name, Use use) {
    const Global* const global = global_of(application, name);
    if (global == nullptr) return;
    Uses& uses = uses_[global];
    if (use == Use::kWrites || use == Use::kPasses) uses.is_written = true;
  }

  /// A frame may be used by data only: as the one that points are given in.
  void add_fathers(const std::vector<StoredValue>& values) {
    for (const StoredValue& value : values) {
      for (const auto& [name, text] : value.attributes) {
        if (name != "fatherId" && !name.ends_with("ink")) continue;
        const auto found = named_.find(std::string_view(text).substr(0, text.find('[')));
        if (found != named_.end()) uses_[found->second];
      }
      for (const StoredField& field : value.fields) add_fathers(field.values);
    }
  }

  void tell_global(const Global& global) {
    const Declaration& declared = global.declared;
    const auto found = uses_.find(&global);
    const auto tell = [&](Severity severity, std::string_view rule, const std::string& what) {
      subject_.tell(severity, rule, declared.file, declared.line, 0, declared.name + what);
    };
    if (found == uses_.end()) return tell(Severity::kNote, check_rules::kUnusedVariable, " is never used");
    if (stores_something(global.values)) return;
    switch (declared.type.kind) {
      case Kind::kScreen:
      case Kind::kUser:
      case Kind::kVoid:
        return;
      case Kind::kDio:
      case Kind::kAio:
      case Kind::kSio:
        // An output is assigned to, which links nothing.
        if (!is_linked(global))
          tell(Severity::kWarning, check_rules::kNeverLinked, " is used and never linked: error 123");
        return;
      default:
        if (!found->second.is_written)
          subject_.tell(Severity::kNote, check_rules::kGlobalNeverSet, declared.file, declared.line, 0,
                        declared.name + " is read and never set: it has the default of its type",
                        subject_.application.form == 7
                            ? "set it in start() if another value is meant: one that equals the default is "
                              "not stored"
                            : "");
    }
  }

  /// By dioLink and its kind, or by reference to a program that may.
  [[nodiscard]] bool is_linked(const Global& global) {
    if (!links_are_known_) {
      links_are_known_ = true;
      for (const ProgramGraph::Node& node : subject_.graph.nodes())
        for (const Line& line : node.program->lines) add_links(node, line);
    }
    return linked_.contains(&global);
  }

  void add_links(const ProgramGraph::Node& node, const Line& line) {
    visit_uses(*node.application, line, [&](const Expression& name, Use use) {
      if (use == Use::kPasses) linked_.insert(global_of(*node.application, name));
    });
    visit_expressions(line, [&](const Expression& e) {
      if (e.kind == Expression::Kind::kCall && e.text.ends_with("Link") && !e.parts.empty())
        linked_.insert(global_of(*node.application, root_of(e.parts[0])));
    });
    // d=d copies the state, and sio=sio perhaps the link
    if (line.kind == Line::Kind::kAssign && line.expressions[0].type.kind == Kind::kSio)
      linked_.insert(global_of(*node.application, root_of(line.expressions[0])));
  }

  const CheckSubject& subject_;
  std::unordered_map<std::string_view, const Global*> named_;
  std::unordered_map<const Global*, Uses> uses_;
  bool links_are_known_ = false;
  std::unordered_set<const Global*> linked_;
  std::unordered_set<const Program*> called_;
};

}  // namespace

void check_globals(const CheckSubject& subject) { GlobalChecks(subject).run(); }

}  // namespace val3
