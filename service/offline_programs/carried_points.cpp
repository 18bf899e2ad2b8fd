#include "service/offline_programs/carried_points.hpp"

namespace cell {
namespace {

/// Words that a line begins with whose `=` assigns no point.
bool begins_block(std::string_view word) {
  for (const std::string_view known : {"for", "if", "elseIf", "while", "until", "case", "switch"})
    if (word == known) return true;
  return false;
}

}  // namespace

bool is_point_type(std::string_view type) { return type.find("point") != std::string_view::npos; }

CarriedPoints::CarriedPoints(const std::vector<ScannedProgram>& programs, const FilteredData& data)
    : data_(data) {
  for (const auto& [name, moved_mm] : data.filtered_variables)
    if (data.kinds.at(name) == StoredKind::kPoint) global_.emplace(name, name);
  for (const ScannedProgram& program : programs) programs_.emplace(program.text.name, &program);
  // Each round that changes something adds a name: it ends.
  for (bool changed = true; changed;) {
    changed = false;
    for (const ScannedProgram& program : programs) changed |= follow(program);
  }
}

bool CarriedPoints::follow(const ScannedProgram& program) {
  bool changed = false;
  for (const auto& tokens : program.lines) {
    changed |= follow_assignment(program, tokens);
    changed |= follow_calls(program, tokens);
  }
  return changed;
}

bool CarriedPoints::follow_assignment(const ScannedProgram& program,
                                      const std::vector<ProgramToken>& tokens) {
  if (tokens.empty() || !is_own_name(tokens, 0) || begins_block(tokens[0].text)) return false;
  std::size_t assigns = 0;
  for (std::size_t i = 1; i < tokens.size() && assigns == 0; ++i)
    if (is_sign(tokens, i, "=")) assigns = i;
  if (assigns == 0) return false;
  const std::string* const origin = origin_in(program, tokens, {assigns + 1, tokens.size()});
  if (origin == nullptr) return false;
  const std::string name(tokens[0].text);
  if (const auto own = program.text.own_types.find(name); own != program.text.own_types.end())
    return is_point_type(own->second) && carries(own_[&program], name, *origin);
  const auto kind = data_.kinds.find(name);
  return kind != data_.kinds.end() && kind->second == StoredKind::kPoint && carries(global_, name, *origin);
}

bool CarriedPoints::follow_calls(const ScannedProgram& program, const std::vector<ProgramToken>& tokens) {
  bool changed = false;
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    if (!is_own_name(tokens, i) || !is_sign(tokens, i + 1, "(")) continue;
    const auto called = programs_.find(tokens[i].text);
    if (called == programs_.end()) continue;
    const ProgramText& text = called->second->text;
    const std::vector<TokenRange> arguments = listed_in(tokens, i + 1);
    for (std::size_t k = 0; k < std::min(arguments.size(), text.parameters.size()); ++k) {
      const std::string* const origin = origin_in(program, tokens, arguments[k]);
      const std::string& name = text.parameters[k];
      if (origin != nullptr && is_point_type(text.own_types.at(name)))
        changed |= carries(own_[called->second], name, *origin);
    }
  }
  return changed;
}

bool CarriedPoints::carries(Names& names, const std::string& name, const std::string& origin) {
  return names.emplace(name, origin).second;
}

const std::string* CarriedPoints::origin_of(const ScannedProgram& program, std::string_view name) const {
  const Names* names = &global_;
  if (program.text.own_types.contains(name)) {
    const auto own = own_.find(&program);
    if (own == own_.end()) return nullptr;
    names = &own->second;
  }
  const auto found = names->find(name);
  return found == names->end() ? nullptr : &found->second;
}

const std::string* CarriedPoints::origin_in(const ScannedProgram& program,
                                            const std::vector<ProgramToken>& tokens, TokenRange range) const {
  for (std::size_t i = range.first; i < range.second; ++i)
    if (is_own_name(tokens, i))
      if (const std::string* const origin = origin_of(program, tokens[i].text)) return origin;
  return nullptr;
}

}  // namespace cell
