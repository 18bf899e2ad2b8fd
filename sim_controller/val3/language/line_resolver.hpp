#pragma once

#include "sim_controller/val3/language/expression_resolver.hpp"

namespace val3 {

/// Resolves the lines of one program.
class LineResolver {
 public:
  LineResolver(Scope& scope, const Program& program, Findings& findings)
      : scope_(scope), program_(program), findings_(findings), expressions_(scope, program, findings) {}

  /// `lines` are the program's; a case looks up its switch there.
  void resolve(std::vector<Line>& lines, Line& line);

 private:
  void resolve_assignment(Line& line);
  void resolve_for(Line& line);
  void resolve_case(const Line& selector, Line& line);
  void resolve_call(Line& line, std::size_t first_argument);
  void resolve_task(Line& line);
  void check_task_name(Expression& name);
  void demand_global(Expression& e, const std::string& what);
  /// The program that a line calls, or null: then it is told, or of a library that is not there.
  const Program* called_program(Line& line);
  void check_argument(Line& line, const Program& called, const Parameter& parameter, Expression& argument);
  void check_reference(Line& line, const Parameter& parameter, const Type& wanted, Expression& argument,
                       const std::string& where);
  void tell(const Line& line, std::string_view rule, std::string what, std::string remedy = {});

  Scope& scope_;
  const Program& program_;
  Findings& findings_;
  ExpressionResolver expressions_;
};

}  // namespace val3
