#include "sim_controller/val3/checks/program_graph.hpp"

#include <algorithm>

#include "sim_controller/val3/checks/uses.hpp"
#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {

const Global* global_of(const Application& application, const Expression& name) {
  if (name.reference.to != Reference::To::kGlobal) return nullptr;
  const Application* const owner = owner_of(application, name.reference.library);
  const auto index = static_cast<std::size_t>(name.reference.index);
  return owner == nullptr || index >= owner->globals.size() ? nullptr : &owner->globals[index];
}

bool uses_channel(const Line& line) {
  if (line.kind != Line::Kind::kAssign) return false;
  const auto channels = std::ranges::count_if(
      line.expressions, [](const Expression& e) { return !e.is_unknown && e.type.kind == Kind::kSio; });
  return channels > 0 && static_cast<std::size_t>(channels) < line.expressions.size();
}

bool ProgramGraph::waits_itself(const Application& application, const Line& line, QuietChannel quiet) const {
  const auto is_no_wait = [&](const Expression& channel) {
    return quiet == QuietChannel::kIsNone && quiet_.surely_contains(application, channel);
  };
  bool waits = false;
  visit_expressions(line, [&](const Expression& e) {
    if (e.kind != Expression::Kind::kCall) return;
    const Instruction* const instruction = e.reference.instruction;
    const bool is_quiet =
        (e.text == "sioGet" || e.text == "sioSet") && !e.parts.empty() && is_no_wait(e.parts[0]);
    const bool may_wait = instruction == nullptr || instruction->may_yield || instruction->may_block;
    waits = waits || (may_wait && !is_quiet);
  });
  if (waits || !uses_channel(line)) return waits;
  return std::ranges::any_of(line.expressions, [&](const Expression& e) {
    return !e.is_unknown && e.type.kind == Kind::kSio && !is_no_wait(e);
  });
}

ProgramGraph::ProgramGraph(const Application& application) {
  std::unordered_set<const Application*> seen;
  add(application, seen);
  for (const Node& node : nodes_)
    for (const Line& line : node.program->lines)
      visit_expressions(line, [&](const Expression& e) { quiet_.add(*node.application, e); });
  for (Node& node : nodes_) fill(node);
  spread(&Node::waits);
  spread(&Node::waits_or_asks);
  find_synchronous();
  for (const Node& node : nodes_) written_.insert(node.writes.begin(), node.writes.end());
}

void ProgramGraph::add(const Application& application, std::unordered_set<const Application*>& seen) {
  if (!seen.insert(&application).second) return;
  for (const Program& program : application.programs) {
    places_.emplace(&program, nodes_.size());
    nodes_.push_back({.application = &application, .program = &program, .calls = {}, .writes = {}});
  }
  for (const Library& library : application.libraries) {
    if (library.application) add(*library.application, seen);
    for (const Loadable& loadable : library.loadable)
      if (loadable.application) add(*loadable.application, seen);
  }
}

void ProgramGraph::fill(Node& node) {
  for (const Line& line : node.program->lines) {
    if (waits_itself(*node.application, line, QuietChannel::kIsNone)) node.waits = true;
    if (waits_itself(*node.application, line, QuietChannel::kIsAWait)) node.waits_or_asks = true;
    if (line.kind == Line::Kind::kCall) {
      if (const Program* const called = called_program(*node.application, line))
        node.calls.push_back(places_.at(called));
      else
        node.calls_unknown = true;
    }
    visit_uses(*node.application, line, [&](const Expression& name, Use use) {
      if (use != Use::kWrites && use != Use::kPasses) return;
      if (const Global* const global = global_of(*node.application, name)) node.writes.insert(global);
    });
  }
  if (node.calls_unknown) node.waits = node.waits_or_asks = true;
  std::ranges::sort(node.calls);
  node.calls.erase(std::ranges::unique(node.calls).begin(), node.calls.end());
}

/// From those that wait to all that call them.
void ProgramGraph::spread(bool Node::*waits) {
  std::vector<std::vector<std::size_t>> callers(nodes_.size());
  std::vector<std::size_t> waiting;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (const std::size_t called : nodes_[i].calls) callers[called].push_back(i);
    if (nodes_[i].*waits) waiting.push_back(i);
  }
  while (!waiting.empty()) {
    const std::size_t one = waiting.back();
    waiting.pop_back();
    for (const std::size_t caller : callers[one]) {
      if (nodes_[caller].*waits) continue;
      nodes_[caller].*waits = true;
      waiting.push_back(caller);
    }
  }
}

void ProgramGraph::find_synchronous() {
  std::unordered_set<const Program*> synchronous;
  for (const Node& node : nodes_)
    for (const Line& line : node.program->lines) {
      if (line.kind != Line::Kind::kTaskCreateSync) continue;
      const Node* const first = called(*node.application, line);
      if (first == nullptr) continue;
      for (const Node* const one : reached(*first)) synchronous.insert(one->program);
    }
  for (Node& node : nodes_) node.is_of_synchronous = synchronous.contains(node.program);
}

const ProgramGraph::Node* ProgramGraph::node_of(const Program& program) const {
  const auto found = places_.find(&program);
  return found == places_.end() ? nullptr : &nodes_[found->second];
}

const ProgramGraph::Node* ProgramGraph::called(const Application& application, const Line& line) const {
  const Program* const program = called_program(application, line);
  return program == nullptr ? nullptr : node_of(*program);
}

std::vector<const ProgramGraph::Node*> ProgramGraph::reached(const Node& from) const {
  std::vector<const Node*> all{&from};
  std::vector<bool> seen(nodes_.size());
  seen[static_cast<std::size_t>(&from - nodes_.data())] = true;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const std::size_t called : all[i]->calls) {
      if (seen[called]) continue;
      seen[called] = true;
      all.push_back(&nodes_[called]);
    }
  return all;
}

bool ProgramGraph::writes(const Node& from, const Global& global) const {
  return std::ranges::any_of(reached(from), [&](const Node* node) { return node->writes.contains(&global); });
}

bool ProgramGraph::waits(const Application& application, const Line& line, QuietChannel quiet) const {
  if (waits_itself(application, line, quiet)) return true;
  if (line.kind != Line::Kind::kCall) return false;
  const Node* const node = called(application, line);
  return node == nullptr || (quiet == QuietChannel::kIsNone ? node->waits : node->waits_or_asks);
}

}  // namespace val3
