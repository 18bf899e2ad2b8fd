#include "sim_controller/val3/language/instructions.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim_controller/val3/language/instruction_table.hpp"

namespace val3 {
namespace {

bool take_suffix(std::string_view& text, std::string_view suffix) {
  if (!text.ends_with(suffix)) return false;
  text.remove_suffix(suffix.size());
  return true;
}

/// The words of `text` between `separator`s, without blanks.
std::vector<std::string_view> words_of(std::string_view text, char separator) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    std::string_view word = text.substr(0, end);
    while (word.starts_with(' ')) word.remove_prefix(1);
    words.push_back(word);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

InstructionParameter parameter_from(std::string_view text) {
  InstructionParameter parameter;
  parameter.optional = take_suffix(text, "?");
  parameter.is_array = take_suffix(text, "[]");
  parameter.writes = take_suffix(text, "&");
  parameter.by_reference = parameter.is_array || parameter.writes;
  parameter.any_kind = text == "any";
  if (parameter.any_kind) return parameter;
  for (const std::string_view word : words_of(text, '|')) {
    const Kind kind = kind_named(word);
    if (kind == Kind::kVoid) throw std::logic_error("no type: " + std::string(word));
    parameter.kinds.push_back(kind);
  }
  return parameter;
}

Signature signature_from(std::string_view text) {
  Signature signature;
  for (const auto& [mark, version] : {std::pair{std::string_view("s6.4 "), instruction_table::kS64},
                                      std::pair{std::string_view("s7 "), instruction_table::kS7}}) {
    if (!text.starts_with(mark)) continue;
    signature.since = version;
    text.remove_prefix(mark.size());
  }
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos || !text.ends_with(')'))
    throw std::logic_error("no signature: " + std::string(text));
  const std::string_view result = text.substr(0, open);
  signature.any_result = result == "any";
  signature.result = kind_named(result);
  text.remove_suffix(1);
  signature.any_arguments = text.substr(open + 1) == "...";
  if (signature.any_arguments) return signature;
  for (const std::string_view one : words_of(text.substr(open + 1), ','))
    signature.parameters.push_back(parameter_from(one));
  return signature;
}

Instruction instruction_from(const instruction_table::Row& row) {
  Instruction instruction{.name = std::string(row.name),
                          .signatures = {},
                          .page5 = row.page5,
                          .page6 = row.page6,
                          .since = row.since,
                          .may_yield = (row.flags & instruction_table::kYields) != 0,
                          .may_block = (row.flags & instruction_table::kBlocks) != 0,
                          .on_library = (row.flags & instruction_table::kOnLibrary) != 0,
                          .addon = row.addon};
  for (const std::string_view one : row.signatures) instruction.signatures.push_back(signature_from(one));
  return instruction;
}

std::vector<Instruction> made_table() {
  std::vector<Instruction> table;
  for (const auto& rows : {instruction_table::of_values(), instruction_table::of_channels(),
                           instruction_table::of_system(), instruction_table::of_motion()})
    for (const instruction_table::Row& row : rows) table.push_back(instruction_from(row));
  std::ranges::sort(table, {}, &Instruction::name);
  return table;
}

const std::vector<Instruction>& the_table() {
  static const std::vector<Instruction> table = made_table();
  return table;
}

bool fits_kind(Kind wanted, const Expression& argument) {
  if (argument.is_unknown) return true;
  if (argument.kind == Expression::Kind::kBraces) {
    const auto fields = fields_of(wanted);
    if (argument.parts.size() > fields.size()) return false;
    for (std::size_t i = 0; i < argument.parts.size(); ++i)
      if (!fits_kind(fields[i].kind, argument.parts[i])) return false;
    return true;
  }
  const Kind given = argument.type.kind;
  return given == wanted || (wanted == Kind::kBool && given == Kind::kDio) ||
         (wanted == Kind::kNum && given == Kind::kAio);
}

bool fits_signature(const Signature& signature, std::span<const Expression> arguments) {
  if (signature.any_arguments) return true;
  if (arguments.size() < least_arguments(signature) || arguments.size() > signature.parameters.size())
    return false;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    if (!fits(signature.parameters[i], arguments[i])) return false;
  return true;
}

}  // namespace

const Instruction* find_instruction(std::string_view name) {
  const auto& table = the_table();
  const auto found = std::ranges::lower_bound(table, name, {}, &Instruction::name);
  return found != table.end() && found->name == name ? &*found : nullptr;
}

std::span<const Instruction> all_instructions() { return the_table(); }

std::size_t least_arguments(const Signature& signature) {
  return static_cast<std::size_t>(
      std::ranges::count(signature.parameters, false, &InstructionParameter::optional));
}

bool fits(const InstructionParameter& parameter, const Expression& argument) {
  if (argument.is_unknown) return true;
  if (parameter.any_kind)
    return argument.type.kind != Kind::kVoid && argument.kind != Expression::Kind::kBraces;
  // A variable that is written is of the type itself: an input gives a value, and takes none.
  if (parameter.by_reference)
    return std::ranges::find(parameter.kinds, argument.type.kind) != parameter.kinds.end();
  return fitting_kind(parameter, argument) != Kind::kVoid;
}

Kind fitting_kind(const InstructionParameter& parameter, const Expression& argument) {
  const auto found =
      std::ranges::find_if(parameter.kinds, [&](Kind kind) { return fits_kind(kind, argument); });
  return found == parameter.kinds.end() ? Kind::kVoid : *found;
}

int fitting_signature(const Instruction& instruction, std::span<const Expression> arguments) {
  for (std::size_t i = 0; i < instruction.signatures.size(); ++i)
    if (fits_signature(instruction.signatures[i], arguments)) return static_cast<int>(i);
  return -1;
}

}  // namespace val3
