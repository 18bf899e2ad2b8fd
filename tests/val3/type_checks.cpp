#include <algorithm>
#include <set>

#include "tests/val3/checks.hpp"
#include "tests/val3/instructions.hpp"

namespace val3 {
namespace {

/// Types of one program. Throws Problem at the first mistake of a statement.
class TypeChecker {
 public:
  TypeChecker(const Application& application, const Program& program)
      : application_(application), program_(program) {}

  void statement(const Statement& s) {
    line_ = s.line;
    const auto& e = s.expressions;
    switch (s.kind) {
      case StatementKind::kAssign:
        return assign(e[0], e[1]);
      case StatementKind::kInstruction:
        instruction(e[0]);
        return;
      case StatementKind::kCall:
        return arguments(s.program, e, 0);
      case StatementKind::kTaskCreate:
        expect(e[0], Type::kString);
        expect(e[1], Type::kNum);
        return arguments(s.program, e, 2);
      case StatementKind::kTaskCreateSync:
        expect(e[0], Type::kString);
        expect(e[1], Type::kNum);
        if (name(e[2]) != Type::kBool) fail("the overrun flag is no bool");
        return arguments(s.program, e, 3);
      case StatementKind::kJumpUnless:
        return expect(e[0], Type::kBool);
      case StatementKind::kJumpUnlessFor:
        for (const Expression& number : e) expect(number, Type::kNum);
        return;
      case StatementKind::kJumpUnlessCase:
        for (const Expression& value : e) expect(value, value_of(e[0]));
        return;
      case StatementKind::kJump:
      case StatementKind::kReturn:
        return;
    }
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { throw Problem{program_.file, line_, text}; }

  void expect(const Expression& e, Type wanted) {
    if (e.kind == ExpressionKind::kBraces && (wanted == Type::kJoint || wanted == Type::kTrsf))
      return braces(e);
    const Type type = value_of(e);
    if (type == Type::kDio && wanted == Type::kBool)
      fail("dio where bool is wanted: compare it, " + e.text + "==true, or assign it first");
    if (type != wanted)
      fail(std::string(name_of(type)) + " where " + std::string(name_of(wanted)) + " is wanted");
  }

  void braces(const Expression& e) {
    if (e.parts.size() != 6) fail("values in braces that are not six");
    for (const Expression& part : e.parts) expect(part, Type::kNum);
  }

  void assign(const Expression& target, const Expression& value) {
    const Type type = name(target);
    if (type == Type::kSio) fail("text over a socket is not part of this subset: sioGet, sioSet");
    // the state of an input is read by assigning it, or by comparing it
    if (type == Type::kBool && value.kind == ExpressionKind::kName && name(value) == Type::kDio) return;
    if (type == Type::kDio && value.kind != ExpressionKind::kBraces) return expect(value, Type::kBool);
    expect(value, type);
  }

  Type variable(const std::string& text) const {
    for (const Parameter& p : program_.parameters)
      if (p.name == text) return p.type;
    for (const Local& l : program_.locals)
      if (l.name == text) return l.type;
    const auto global = application_.globals.find(text);
    return global == application_.globals.end() ? Type::kNone : global->second.type;
  }

  /// Of a variable, an element or a field.
  Type name(const Expression& e) {
    if (e.kind != ExpressionKind::kName) fail("a variable is wanted here");
    Type type = variable(e.text);
    if (type == Type::kNone) fail("nothing is called " + e.text);
    for (const Expression& index : e.parts) expect(index, Type::kNum);
    for (const std::string& field : e.fields) {
      const Type inner = field_type(type, field);
      if (inner == Type::kNone) fail(std::string(name_of(type)) + " has no field " + field);
      type = inner;
    }
    return type;
  }

  Type value_of(const Expression& e) {
    switch (e.kind) {
      case ExpressionKind::kNumber:
        return Type::kNum;
      case ExpressionKind::kTruth:
        return Type::kBool;
      case ExpressionKind::kText:
        return Type::kString;
      case ExpressionKind::kName:
        if (variable(e.text) == Type::kNone &&
            (e.text == "off" || e.text == "joint" || e.text == "Cartesian"))
          return Type::kBlend;
        return name(e);
      case ExpressionKind::kInstruction: {
        const Type type = instruction(e);
        if (type == Type::kNone) fail(e.text + " has no value");
        return type;
      }
      case ExpressionKind::kUnary: {
        const Type type = e.text == "!" ? Type::kBool : Type::kNum;
        expect(e.parts[0], type);
        return type;
      }
      case ExpressionKind::kBinary:
        return binary(e);
      case ExpressionKind::kBraces:
        fail("values in braces where nothing says what they are");
    }
    fail("no expression");
  }

  Type binary(const Expression& e) {
    const std::string& sign = e.text;
    if (sign == "and" || sign == "or") {
      expect(e.parts[0], Type::kBool);
      expect(e.parts[1], Type::kBool);
      return Type::kBool;
    }
    const bool compares = sign == "==" || sign == "!=";
    const auto read = [compares](Type type) { return compares && type == Type::kDio ? Type::kBool : type; };
    const Type type = read(value_of(e.parts[0]));
    if (type != read(value_of(e.parts[1]))) fail("operator " + sign + " between two types");
    const std::set<std::string> numbers{"+", "-", "*", "/", "%", "==", "!=", "<", "<=", ">", ">="};
    const std::set<std::string> texts{"+", "==", "!=", "<", "<=", ">", ">="};
    const std::set<std::string> joints{"+", "-", "==", "!="};
    const std::set<std::string> bools{"==", "!="};
    const std::set<std::string> none;
    const auto& known = type == Type::kNum      ? numbers
                        : type == Type::kString ? texts
                        : type == Type::kJoint  ? joints
                        : type == Type::kBool   ? bools
                                                : none;
    if (!known.contains(sign)) fail("no operator " + sign + " for " + std::string(name_of(type)));
    return sign.size() == 2 || sign == "<" || sign == ">" ? Type::kBool : type;
  }

  Type instruction(const Expression& e) {
    const Instruction* known = find_instruction(e.text);
    if (known == nullptr) {
      if (application_.programs.contains(e.text)) fail(e.text + " is a program: call " + e.text);
      fail("no instruction is called " + e.text);
    }
    const auto& parameters = known->parameters;
    const auto needed =
        static_cast<std::size_t>(std::ranges::count(parameters, false, &InstructionParameter::optional));
    if (e.parts.size() < needed || e.parts.size() > parameters.size())
      fail(e.text + " takes " + std::to_string(needed) + " arguments");
    for (std::size_t i = 0; i < e.parts.size(); ++i) {
      const InstructionParameter& p = parameters[i];
      if (!p.by_reference && p.types.size() == 1) {
        expect(e.parts[i], p.types[0]);
        continue;
      }
      const Type type = p.by_reference ? name(e.parts[i]) : value_of(e.parts[i]);
      if (std::ranges::none_of(p.types, [&](Type t) { return t == type; }))
        fail(e.text + ": argument " + std::to_string(i + 1) + " is " + std::string(name_of(type)));
      if (p.is_array && !e.parts[i].fields.empty()) fail(e.text + ": a field is no array");
    }
    return known->result;
  }

  void arguments(const std::string& program, const std::vector<Expression>& e, std::size_t first) {
    const auto found = application_.programs.find(program);
    if (found == application_.programs.end()) fail("no program is called " + program);
    const auto& parameters = found->second.parameters;
    if (e.size() - first != parameters.size())
      fail(program + " takes " + std::to_string(parameters.size()) + " arguments");
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Expression& argument = e[first + i];
      if (!parameters[i].by_reference) {
        expect(argument, parameters[i].type);
        continue;
      }
      if (name(argument) != parameters[i].type)
        fail(program + ": " + parameters[i].name + " has another type");
      if (parameters[i].is_array && !argument.fields.empty()) fail(program + ": a field is no array");
    }
  }

  const Application& application_;
  const Program& program_;
  int line_ = 0;
};

}  // namespace

void check_types(const Application& application, std::vector<Problem>& problems) {
  for (const auto& [name, program] : application.programs) {
    TypeChecker checker(application, program);
    for (const Statement& s : program.statements) {
      try {
        checker.statement(s);
      } catch (const Problem& problem) {
        problems.push_back(problem);
      }
    }
  }
}

}  // namespace val3
