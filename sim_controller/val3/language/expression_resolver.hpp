#pragma once

#include <string>
#include <string_view>

#include "sim_controller/val3/language/scope.hpp"
#include "sim_controller/val3/program/finding.hpp"

namespace val3 {

struct Instruction;
struct Signature;

/// Fills what is the resolver's in one program's expressions, and tells what is wrong with them. An
/// expression in which something was found has no type from then on (is_unknown): one mistake is told once.
class ExpressionResolver {
 public:
  ExpressionResolver(Scope& scope, const Program& program, Findings& findings)
      : scope_(scope), program_(program), findings_(findings) {}

  /// Types an expression from its parts. Values in braces remain without one.
  void resolve(Expression& e);
  /// Resolves a value that becomes one of `wanted`, as by assignment; `where` says which in a message: "the
  /// priority".
  void resolve_as(Expression& e, const Type& wanted, std::string_view where);
  /// As resolve_as, of an expression that is resolved.
  void expect(Expression& e, const Type& wanted, std::string_view where);
  /// A dio by itself is no bool, also where a program or an instruction takes one.
  void demand_no_signal(Expression& e, Kind wanted, const std::string& where);
  /// Resolves what `if`, `while` and their kind ask.
  void resolve_condition(Expression& e);
  /// Resolves what a value is put into; false when it is no variable, which is told.
  bool resolve_place(Expression& e);
  /// Both sides of a comparison, resolved: values in braces get the type of the other side.
  /// False when they cannot be compared.
  bool comparable(Expression& left, Expression& right);

  void tell(Severity severity, std::string_view rule, const Expression& at, std::string what,
            std::string remedy = {});
  /// An error after which the expression has no type.
  void fail(std::string_view rule, Expression& at, std::string what, std::string remedy = {});
  [[nodiscard]] std::string type_name(const Expression& e) const;
  [[nodiscard]] std::string type_name(const Type& type) const { return name_of(scope_.application(), type); }
  [[nodiscard]] Shape shape(const Expression& e) const { return shape_of(scope_, program_, e); }

 private:
  void resolve_name(Expression& e);
  void resolve_undefined(Expression& e);
  void resolve_library_name(Expression& e);
  void resolve_unknown_signal(const Application& io, Expression& e);
  void resolve_index(Expression& e);
  void check_index(const Shape& shape, Expression& e);
  void resolve_field(Expression& e);
  void resolve_call(Expression& e);
  const Instruction* called_instruction(Expression& e);
  void tell_addon(Expression& e);
  void tell_misfit(const Instruction& instruction, Expression& e);
  void type_arguments(const Signature& signature, Expression& e);
  void resolve_unary(Expression& e);
  void resolve_binary(Expression& e);
  void resolve_logical(Expression& e);
  void resolve_arithmetic(Expression& e);
  bool be_bool(Expression& e);
  bool has_result(Expression& e);
  void fail_without_type(Expression& e);
  bool type_braces(Expression& e, const Type& wanted);

  Scope& scope_;
  const Program& program_;
  Findings& findings_;
};

/// A value of `given` can be put into a variable of `wanted`: of one type, or by an input, an output or a
/// channel.
bool can_be_put(const Type& wanted, const Type& given);
/// Where its name stands, as messages write it: "alias:name".
std::string full_name(const Expression& e);

}  // namespace val3
