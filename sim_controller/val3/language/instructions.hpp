#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// A parameter of an instruction.
struct InstructionParameter {
  std::vector<Kind> kinds;    // any of them
  bool by_reference = false;  // a variable
  bool writes = false;        // the variable gets a value
  bool is_array = false;      // with all elements from the one named; by reference
  bool optional = false;
  bool any_kind = false;  // size(), append(): of any type
};

struct Signature {
  Kind result = Kind::kVoid;
  bool any_result = false;     // no manual says of what type
  bool any_arguments = false;  // nor what it takes: its arguments are not checked
  std::vector<InstructionParameter> parameters;
  Version since{5, 0};  // where it is newer than the instruction itself
};

/// One instruction of the language: the table of the manuals (val3 5.3 and 6, the add-ons) and of s7 and s8
/// programs.
struct Instruction {
  std::string name;
  std::vector<Signature> signatures;
  int page5 = 0;        // of the manual of version 5.3; 0: not in it
  int page6 = 0;        // of the manual of version 6; 0: not in it
  Version since{5, 0};  // the first version that has it
  bool may_yield = false;
  bool may_block = false;   // the task waits in it
  bool on_library = false;  // written alias:name(...): libLoad and its kind
  std::string_view addon;   // of an add-on or an option: which; empty else
};

/// The instruction of that name, or null.
const Instruction* find_instruction(std::string_view name);
/// All of them, by name.
std::span<const Instruction> all_instructions();
/// The line of a call that fits: index of its signature, or -1. The arguments are resolved but for values in
/// braces, which fit every type with as many fields.
int fitting_signature(const Instruction& instruction, std::span<const Expression> arguments);
/// An argument fits that parameter.
bool fits(const InstructionParameter& parameter, const Expression& argument);
/// The first of a parameter's types that a value fits; kVoid when it fits none.
Kind fitting_kind(const InstructionParameter& parameter, const Expression& argument);
/// How many arguments a signature takes at least; at most it takes one for each of its parameters.
std::size_t least_arguments(const Signature& signature);

}  // namespace val3
