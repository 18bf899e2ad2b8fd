#include "tests/val3/instructions.hpp"

#include <algorithm>
#include <cctype>
#include <map>

namespace val3 {
namespace {

std::string_view trim(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// The piece up to `separator`, which is removed with it.
std::string_view cut(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view piece = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trim(piece);
}

InstructionParameter parameter(std::string_view text) {
  InstructionParameter result;
  if (text.starts_with('?')) {
    result.optional = true;
    text.remove_prefix(1);
  }
  if (text.ends_with('&')) {
    result.writes = result.by_reference = true;
    text.remove_suffix(1);
  }
  if (text.ends_with("[]")) {
    result.is_array = result.by_reference = true;
    text.remove_suffix(2);
  }
  while (!text.empty()) {
    const Type type = type_named(cut(text, '|'));
    if (type == Type::kNone) throw std::logic_error("a type in a signature");
    result.types.push_back(type);
  }
  return result;
}

/// Carried out by the interpreter, since they concern tasks.
std::vector<Instruction> task_instructions() {
  std::vector<Instruction> list;
  list.push_back(instruction("void delay(num)", {}));
  list.push_back(instruction("void wait(bool)", {}, true));
  list.push_back(instruction("bool watch(bool, num)", {}, true));
  list.push_back(instruction("void waitEndMove()", {}, true));
  list.push_back(instruction("void taskKill(string)", {}));
  list.push_back(instruction("num taskStatus(string)", {}));
  list.push_back(instruction("void taskSuspend(string)", {}));
  list.push_back(instruction("void taskResume(string, num)", {}));
  return list;
}

}  // namespace

Instruction instruction(std::string_view signature, std::function<Value(Call&)> run, bool blocks) {
  Instruction result{.blocks = blocks, .run = std::move(run)};
  result.result = type_named(cut(signature, ' '));
  result.name = cut(signature, '(');
  signature.remove_suffix(1);
  while (!signature.empty()) result.parameters.push_back(parameter(cut(signature, ',')));
  return result;
}

const Instruction* find_instruction(std::string_view name) {
  static const std::map<std::string, Instruction, std::less<>> table = [] {
    std::map<std::string, Instruction, std::less<>> all;
    for (const auto& part :
         {task_instructions(), number_and_text_instructions(), socket_instructions(), arm_instructions()})
      for (const Instruction& i : part) all.emplace(i.name, i);
    return all;
  }();
  const auto found = table.find(name);
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace val3
