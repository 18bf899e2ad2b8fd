#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tests/val3/problem.hpp"
#include "tests/val3/values.hpp"

namespace val3 {

enum class ExpressionKind { kNumber, kTruth, kText, kName, kInstruction, kUnary, kBinary, kBraces };

struct Expression {
  ExpressionKind kind{};
  int line = 0;
  std::string text;  // the text, name, instruction or operator
  double number = 0.0;
  std::vector<Expression> parts;    // index of a name; arguments; operands
  std::vector<std::string> fields;  // of a name: what follows it with dots
};

enum class StatementKind {
  kAssign,          // expressions: place, value
  kInstruction,     // expressions: the instruction
  kCall,            // program, expressions: arguments
  kTaskCreate,      // program; expressions: name, priority, arguments...
  kTaskCreateSync,  // program; expressions: name, period, overrun flag, arguments...
  kJump,            // target
  kJumpUnless,      // expressions: condition; target
  kJumpUnlessFor,   // expressions: counter, last, step; target
  kJumpUnlessCase,  // expressions: selector, values...; target
  kReturn,
};

/// One statement of a program laid out flat: control structures are jumps to a statement's index.
struct Statement {
  StatementKind kind{};
  int line = 0;
  std::vector<Expression> expressions;
  std::string program;
  std::size_t target = 0;
};

struct Parameter {
  std::string name;
  Type type{};
  bool is_array = false;
  bool by_reference = false;  // always true for an array
};

struct Local {
  std::string name;
  Type type{};
  std::size_t size = 1;
};

struct Program {
  std::string name;
  std::string file;
  std::vector<Parameter> parameters;
  std::vector<Local> locals;
  std::vector<Statement> statements;  // the last one is kReturn
};

struct Global {
  Type type{};
  Place place;
  int line = 0;
};

/// A VAL3 application as it stands in its files.
struct Application {
  std::string name;
  std::map<std::string, Program, std::less<>> programs;
  std::map<std::string, Global, std::less<>> globals;
};

}  // namespace val3
