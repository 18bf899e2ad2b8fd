#pragma once

#include <functional>
#include <optional>

#include "sim_controller/val3/language/scope.hpp"
#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What a line does with a variable.
enum class Use {
  kReads,
  kWrites,
  kPasses,    // by reference, to a program or an instruction that may do both
  kMeasures,  // size() and its kind: the elements, not their values
};

/// Tells every variable that a line names, with its use: the name at the root of x[i].f, in the order in
/// which the line is carried out. `application` is that of the line's program, and resolved.
using UseVisitor = std::function<void(const Expression& name, Use use)>;
void visit_uses(const Application& application, const Line& line, const UseVisitor& visit);

/// Every expression of a line, with what is in it; the outer before the inner.
using ExpressionVisitor = std::function<void(const Expression&)>;
void visit_expressions(const Line& line, const ExpressionVisitor& visit);
void visit_expressions(const Expression& e, const ExpressionVisitor& visit);

/// A number as it is written, with its sign; nothing for any other expression.
std::optional<double> constant_of(const Expression& e);

/// Whether a condition of constants holds: `false`, `1==1`, `!true`; nothing where it depends on more.
std::optional<bool> constant_truth(const Expression& e);

/// The application that a reference or a call is into; null when it is not there.
const Application* owner_of(const Application& application, int library);
const Program* called_program(const Application& application, const Line& line);

}  // namespace val3
