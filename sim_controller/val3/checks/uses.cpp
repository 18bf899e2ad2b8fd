#include "sim_controller/val3/checks/uses.hpp"

#include "sim_controller/val3/language/instructions.hpp"

namespace val3 {
namespace {

class UsesOfLine {
 public:
  UsesOfLine(const Application& application, const UseVisitor& visit)
      : application_(application), visit_(visit) {}

  void line(const Line& line) {
    const auto& e = line.expressions;
    switch (line.kind) {
      case Line::Kind::kAssign:
        if (e.empty()) return;
        read(e.back());
        for (std::size_t i = e.size() - 1; i-- > 0;) place(e[i], Use::kWrites);
        return;
      case Line::Kind::kFor:
        for (std::size_t i = 1; i < e.size(); ++i) read(e[i]);
        if (!e.empty()) place(e[0], Use::kWrites);
        return;
      case Line::Kind::kCall:
        return arguments(line, 0);
      case Line::Kind::kTaskCreate:
        return task(line, 2);
      case Line::Kind::kTaskCreateSync:
        return task(line, 3);
      default:
        for (const Expression& one : e) read(one);
    }
  }

 private:
  void task(const Line& line, std::size_t leading) {
    for (std::size_t i = 0; i < leading && i < line.expressions.size(); ++i)
      if (i == 2)
        place(line.expressions[i], Use::kPasses);
      else
        read(line.expressions[i]);
    arguments(line, leading);
  }

  void arguments(const Line& line, std::size_t first) {
    const Program* const called = called_program(application_, line);
    for (std::size_t i = first; i < line.expressions.size(); ++i) {
      const std::size_t at = i - first;
      const bool is_value =
          called != nullptr && (at >= called->parameters.size() || !called->parameters[at].by_reference);
      place(line.expressions[i], is_value ? Use::kReads : Use::kPasses);
    }
  }

  void read(const Expression& e) { place(e, Use::kReads); }

  void place(const Expression& e, Use use) {
    switch (e.kind) {
      case Expression::Kind::kName:
        visit_(e, use);
        return;
      case Expression::Kind::kIndex:
        for (std::size_t i = 1; i < e.parts.size(); ++i) read(e.parts[i]);
        return place(e.parts[0], use);
      case Expression::Kind::kField:
        return place(e.parts[0], use);
      case Expression::Kind::kCall:
        return call(e);
      default:
        for (const Expression& part : e.parts) read(part);
    }
  }

  void call(const Expression& e) {
    const Instruction* const instruction = e.reference.instruction;
    const auto signature = static_cast<std::size_t>(e.reference.index);
    const bool is_known =
        instruction != nullptr && e.reference.index >= 0 && signature < instruction->signatures.size();
    for (std::size_t i = 0; i < e.parts.size(); ++i) {
      Use use = Use::kPasses;
      if (is_known && i < instruction->signatures[signature].parameters.size()) {
        const InstructionParameter& parameter = instruction->signatures[signature].parameters[i];
        use = parameter.writes     ? (parameter.any_kind ? Use::kPasses : Use::kWrites)
              : parameter.any_kind ? Use::kMeasures
                                   : Use::kReads;
      }
      place(e.parts[i], use);
    }
  }

  const Application& application_;
  const UseVisitor& visit_;
};

}  // namespace

void visit_uses(const Application& application, const Line& line, const UseVisitor& visit) {
  UsesOfLine(application, visit).line(line);
}

void visit_expressions(const Expression& e, const ExpressionVisitor& visit) {
  visit(e);
  for (const Expression& part : e.parts) visit_expressions(part, visit);
}

void visit_expressions(const Line& line, const ExpressionVisitor& visit) {
  for (const Expression& e : line.expressions) visit_expressions(e, visit);
}

std::optional<double> constant_of(const Expression& e) {
  if (e.kind == Expression::Kind::kNumber) return e.number;
  if (e.kind == Expression::Kind::kUnary && e.text == "-" && e.parts.size() == 1 &&
      e.parts[0].kind == Expression::Kind::kNumber)
    return -e.parts[0].number;
  return std::nullopt;
}

std::optional<bool> constant_truth(const Expression& e) {
  if (e.kind == Expression::Kind::kTruth) return e.number != 0.0;
  if (e.kind == Expression::Kind::kUnary && e.text == "!") {
    const auto part = constant_truth(e.parts[0]);
    return part ? std::optional(!*part) : std::nullopt;
  }
  if (e.kind != Expression::Kind::kBinary) return std::nullopt;
  if (e.text == "and" || e.text == "or") {
    const auto left = constant_truth(e.parts[0]);
    const auto right = constant_truth(e.parts[1]);
    // One side decides by itself: the left one, as the right one is then not asked.
    if (left && *left == (e.text == "or")) return left;
    return left ? right : std::nullopt;
  }
  const auto left = constant_of(e.parts[0]);
  const auto right = constant_of(e.parts[1]);
  if (!left || !right) return std::nullopt;
  if (e.text == "==") return *left == *right;
  if (e.text == "!=") return *left != *right;
  if (e.text == "<") return *left < *right;
  if (e.text == ">") return *left > *right;
  if (e.text == "<=") return *left <= *right;
  if (e.text == ">=") return *left >= *right;
  return std::nullopt;
}

const Application* owner_of(const Application& application, int library) {
  if (library < 0) return &application;
  const auto index = static_cast<std::size_t>(library);
  return index < application.libraries.size() ? application.libraries[index].application.get() : nullptr;
}

const Program* called_program(const Application& application, const Line& line) {
  const Application* const owner = owner_of(application, line.called_library);
  const auto index = static_cast<std::size_t>(line.called_program);
  if (owner == nullptr || line.called_program < 0 || index >= owner->programs.size()) return nullptr;
  return &owner->programs[index];
}

}  // namespace val3
