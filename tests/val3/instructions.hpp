#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/val3/cabinet.hpp"
#include "tests/val3/program.hpp"

namespace val3 {

/// Arguments of one instruction: `values` for those by value, `places` for those by reference, each at the
/// argument's index.
struct Call {
  Cabinet& cabinet;
  const Application& application;
  std::vector<Value> values;
  std::vector<Place> places;

  [[nodiscard]] double number(std::size_t i) const { return std::get<double>(values.at(i)); }
  [[nodiscard]] const std::string& text(std::size_t i) const { return std::get<std::string>(values.at(i)); }
  template <class T>
  [[nodiscard]] const T& value(std::size_t i) const {
    return std::get<T>(values.at(i));
  }
};

/// Thrown by a statement that has to be carried out again in the next tick.
struct Blocked {};

struct InstructionParameter {
  std::vector<Type> types;  // any of them
  bool by_reference = false;
  bool is_array = false;  // by reference, with all elements from the one named
  bool writes = false;
  bool optional = false;
};

struct Instruction {
  std::string name;
  Type result = Type::kNone;
  std::vector<InstructionParameter> parameters;
  bool blocks = false;
  /// Empty for those that the interpreter carries out itself: tasks and waiting.
  std::function<Value(Call&)> run;
};

/// The instruction of that name that this subset has, or null.
const Instruction* find_instruction(std::string_view name);

// The parts of the table, each in a file of its own. `signature` is like "bool pointToJoint(tool, jointRx,
// pointRx, jointRx&)": "a|b" takes both types, "&" is written to, "[]" an array, "?" in front may be left
// out.
Instruction instruction(std::string_view signature, std::function<Value(Call&)> run, bool blocks = false);
std::vector<Instruction> number_and_text_instructions();
std::vector<Instruction> socket_instructions();
std::vector<Instruction> arm_instructions();

}  // namespace val3
