/// Calls of instructions: which it is, which of its signatures, and what its arguments are.
#include <algorithm>

#include "sim_controller/val3/language/expression_resolver.hpp"
#include "sim_controller/val3/language/instructions.hpp"
#include "sim_controller/val3/language/resolver_rules.hpp"

namespace val3 {
namespace {

/// "2", "2 or 3", "1 to 3".
std::string counts_of(const Instruction& instruction, std::size_t& least, std::size_t& most) {
  least = most = instruction.signatures.empty() ? 0 : least_arguments(instruction.signatures[0]);
  for (const Signature& signature : instruction.signatures) {
    least = std::min(least, least_arguments(signature));
    most = std::max(most, signature.parameters.size());
  }
  if (least == most) return std::to_string(least);
  return std::to_string(least) + (most == least + 1 ? " or " : " to ") + std::to_string(most);
}

std::string kinds_of(const InstructionParameter& parameter) {
  if (parameter.any_kind) return "variable";
  std::string text;
  for (std::size_t i = 0; i < parameter.kinds.size(); ++i) {
    if (i > 0) text += i + 1 == parameter.kinds.size() ? " or " : ", ";
    text += name_of(parameter.kinds[i]);
  }
  return text;
}

/// The first argument that does not fit, and how many before it do.
std::size_t first_misfit(const Signature& signature, const std::vector<Expression>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i)
    if (i >= signature.parameters.size() || !fits(signature.parameters[i], arguments[i])) return i;
  return arguments.size();
}

/// The signature that fits farthest, of those that take so many arguments.
const Signature* nearest_signature(const Instruction& instruction, const std::vector<Expression>& arguments) {
  const Signature* nearest = nullptr;
  for (const Signature& signature : instruction.signatures) {
    if (arguments.size() < least_arguments(signature) || arguments.size() > signature.parameters.size())
      continue;
    if (nearest == nullptr || first_misfit(signature, arguments) > first_misfit(*nearest, arguments))
      nearest = &signature;
  }
  return nearest;
}

}  // namespace

const Instruction* ExpressionResolver::called_instruction(Expression& e) {
  const Instruction* const instruction = find_instruction(e.text);
  if (!e.alias.empty()) {
    if (scope_.library(e.alias) < 0 && !(e.alias == "io" && scope_.application().form == 5)) {
      fail(resolver_rules::kUndefinedLibrary, e, "no library has the alias " + e.alias,
           "declare it in the project");
      return nullptr;
    }
    if (instruction != nullptr && instruction->on_library) return instruction;
    if (e.text.starts_with('$')) {
      tell_addon(e);
      return nullptr;
    }
    fail(resolver_rules::kProgramWithoutCall, e, full_name(e) + " is no instruction for a library",
         "to call a program, write call " + full_name(e) + "(...)");
    return nullptr;
  }
  // A program of an instruction's name is reached by `call` only.
  if (instruction != nullptr) return instruction;
  if (scope_.program(e.text) >= 0) {
    fail(resolver_rules::kProgramWithoutCall, e, e.text + " is a program", "write call " + e.text + "(...)");
    return nullptr;
  }
  if (e.text.starts_with('$')) {
    tell_addon(e);
    return nullptr;
  }
  if (scope_.application().language >= Version{8, 0, 0}) {
    tell(Severity::kWarning, resolver_rules::kUndefinedInstruction, e,
         "no instruction that is known here is called " + e.text, "correct the name where s8 has none of it");
    e.is_unknown = true;
    return nullptr;
  }
  fail(resolver_rules::kUndefinedInstruction, e, "no instruction is called " + e.text);
  return nullptr;
}

void ExpressionResolver::tell_addon(Expression& e) {
  tell(Severity::kNote, resolver_rules::kUnknownAddon, e,
       e.text + "() is of an add-on: its arguments are not checked");
  e.is_unknown = true;
}

void ExpressionResolver::resolve_call(Expression& e) {
  for (Expression& argument : e.parts) resolve(argument);
  const Instruction* const instruction = called_instruction(e);
  if (instruction == nullptr) return;
  e.reference = {Reference::To::kInstruction, -1, -1, instruction};
  const int fitting = fitting_signature(*instruction, e.parts);
  if (fitting < 0) {
    const bool is_told = std::ranges::any_of(e.parts, &Expression::is_unknown);
    if (!is_told) tell_misfit(*instruction, e);
    e.is_unknown = true;
    return;
  }
  e.reference.index = fitting;
  const Signature& signature = instruction->signatures[static_cast<std::size_t>(fitting)];
  e.type = {signature.result, -1};
  // What has no type fits several signatures: the result may be another's.
  e.is_unknown = signature.any_result || (instruction->signatures.size() > 1 &&
                                          std::ranges::any_of(e.parts, &Expression::is_unknown));
  if (!signature.any_arguments) type_arguments(signature, e);
}

void ExpressionResolver::tell_misfit(const Instruction& instruction, Expression& e) {
  std::size_t least = 0, most = 0;
  const std::string counts = counts_of(instruction, least, most);
  const std::size_t given = e.parts.size();
  const Signature* const nearest = nearest_signature(instruction, e.parts);
  if (nearest == nullptr)
    return fail(given < most ? resolver_rules::kMissingArgument : resolver_rules::kExtraArgument, e,
                e.text + "() takes " + counts + " arguments, and " + std::to_string(given) + " are given");
  const std::size_t wrong = first_misfit(*nearest, e.parts);
  Expression& argument = e.parts[wrong];
  if (!has_result(argument)) return;
  const std::string wanted = kinds_of(nearest->parameters[wrong]);
  const bool is_braces = argument.kind == Expression::Kind::kBraces;
  fail(is_braces ? resolver_rules::kBraces : resolver_rules::kWrongType, argument,
       "argument " + std::to_string(wrong + 1) + " of " + e.text + "() is a " + wanted + ", and this is " +
           (is_braces ? std::to_string(argument.parts.size()) + " values in braces"
                      : "a " + type_name(argument)));
}

void ExpressionResolver::type_arguments(const Signature& signature, Expression& e) {
  for (std::size_t i = 0; i < e.parts.size(); ++i) {
    Expression& argument = e.parts[i];
    const InstructionParameter& parameter = signature.parameters[i];
    if (argument.kind == Expression::Kind::kBraces && !argument.is_unknown) {
      if (const Kind kind = fitting_kind(parameter, argument); kind != Kind::kVoid)
        type_braces(argument, {kind, -1});
    } else if (!parameter.by_reference && parameter.kinds.size() == 1 &&
               e.text != "sel") {  // programs in use have sel(d,..)
      demand_no_signal(argument, parameter.kinds[0],
                       "argument " + std::to_string(i + 1) + " of " + e.text + "()");
    } else if (parameter.by_reference && !argument.is_place && !argument.is_unknown) {
      fail(resolver_rules::kNotAVariable, argument,
           "argument " + std::to_string(i + 1) + " of " + e.text + "() is a variable, and this is a value");
    }
  }
}

}  // namespace val3
