/// Sockets that are used and never closed.
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/checks/subject.hpp"
#include "sim_controller/val3/checks/uses.hpp"

namespace val3 {
namespace {

bool is_socket(const Global& global) {
  return std::ranges::any_of(global.values, [](const StoredValue& value) {
    const auto link = value.attributes.find("link");
    return link != value.attributes.end() && link->second.starts_with("Socket\\");
  });
}

class ChannelChecks {
 public:
  explicit ChannelChecks(const CheckSubject& subject) : subject_(subject) {}

  void run() {
    close_parameters();
    for (const ProgramGraph::Node& node : subject_.graph.nodes())
      for (const Line& line : node.program->lines) line_of(node, line);
    for (const Global& global : subject_.application.globals) {
      const auto used = used_.find(&global);
      if (used == used_.end() || closed_.contains(&global) || !is_socket(global)) continue;
      subject_.tell(
          Severity::kWarning, check_rules::kSocketNeverClosed, *used->second.program, *used->second.at,
          "the socket " + global.declared.name + " is used and never closed",
          "call clearBuffer(" + global.declared.name + ") when the connection is lost, and in stop()");
    }
  }

 private:
  struct FirstUse {
    const Program* program = nullptr;
    const Line* at = nullptr;
  };
  using ClosedParameters = std::unordered_map<const Program*, std::unordered_set<std::size_t>>;

  /// Parameters that a program closes, itself or by what it calls.
  void close_parameters() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const ProgramGraph::Node& node : subject_.graph.nodes()) {
        const bool has_channel = std::ranges::any_of(
            node.program->parameters, [](const Parameter& p) { return p.type.kind == Kind::kSio; });
        if (!has_channel) continue;
        for (const Line& line : node.program->lines)
          visit_closed(node, line, [&](const Expression& channel) {
            if (channel.reference.to == Reference::To::kParameter)
              changed |=
                  parameters_[node.program].insert(static_cast<std::size_t>(channel.reference.index)).second;
          });
      }
    }
  }

  /// Channels that a line closes; one of which another becomes a copy is taken as closed there.
  template <class Visit>
  void visit_closed(const ProgramGraph::Node& node, const Line& line, const Visit& visit) const {
    visit_expressions(line, [&](const Expression& e) {
      if (e.kind != Expression::Kind::kCall) return;
      if (e.text == "clearBuffer" && e.parts.size() == 1) visit(root_of(e.parts[0]));
      if (e.text == "sioLink" && e.parts.size() == 2) visit(root_of(e.parts[1]));
    });
    if (line.kind == Line::Kind::kAssign &&
        std::ranges::all_of(line.expressions, [](const Expression& e) { return e.type.kind == Kind::kSio; }))
      visit(root_of(line.expressions.back()));
    if (line.kind == Line::Kind::kCall || line.kind == Line::Kind::kTaskCreate ||
        line.kind == Line::Kind::kTaskCreateSync)
      visit_closed_arguments(node, line, visit);
  }

  template <class Visit>
  void visit_closed_arguments(const ProgramGraph::Node& node, const Line& line, const Visit& visit) const {
    const std::size_t first = line.kind == Line::Kind::kCall         ? 0
                              : line.kind == Line::Kind::kTaskCreate ? 2
                                                                     : 3;
    const Program* const called = called_program(*node.application, line);
    for (std::size_t i = first; i < line.expressions.size(); ++i) {
      if (line.expressions[i].type.kind != Kind::kSio) continue;
      const auto known = parameters_.find(called);
      if (called == nullptr || (known != parameters_.end() && known->second.contains(i - first)))
        visit(root_of(line.expressions[i]));
    }
  }

  void line_of(const ProgramGraph::Node& node, const Line& line) {
    visit_closed(node, line,
                 [&](const Expression& channel) { closed_.insert(global_of(*node.application, channel)); });
    visit_expressions(line, [&](const Expression& e) {
      if (e.kind == Expression::Kind::kCall && (e.text == "sioGet" || e.text == "sioSet") && !e.parts.empty())
        add_use(node, line, e.parts[0]);
    });
    // By =, or by a program that has it as a parameter.
    if (line.kind == Line::Kind::kInstruction) return;
    for (const Expression& e : line.expressions) add_use(node, line, e);
  }

  void add_use(const ProgramGraph::Node& node, const Line& line, const Expression& channel) {
    if (channel.type.kind != Kind::kSio) return;
    if (const Global* const global = global_of(*node.application, root_of(channel)))
      used_.try_emplace(global, FirstUse{node.program, &line});
  }

  const CheckSubject& subject_;
  ClosedParameters parameters_;
  std::unordered_set<const Global*> closed_;
  std::unordered_map<const Global*, FirstUse> used_;
};

}  // namespace

void check_channels(const CheckSubject& subject) { ChannelChecks(subject).run(); }

}  // namespace val3
