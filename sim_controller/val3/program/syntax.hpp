#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim_controller/val3/program/type.hpp"

/// A program as its lines say it: the parser fills everything but what is marked as the resolver's.
namespace val3 {

struct Instruction;

/// What a name stands for.
struct Reference {
  enum class To {
    kNothing,
    kLocal,        // index: of Program::locals
    kParameter,    // index: of Program::parameters
    kGlobal,       // library, index: of that application's globals
    kWord,         // a value of blend, shoulder, elbow or wrist: index is its place in the type's list
    kInstruction,  // instruction, and index of its signature
    kWorld,        // the frame that is always there
    kFlange,       // the tool that is always there
  };
  To to = To::kNothing;
  int library = -1;  // index of Application::libraries; -1: the application itself
  int index = -1;
  const Instruction* instruction = nullptr;
};

struct Expression {
  enum class Kind {
    kNumber,  // number
    kTruth,   // number: 0 or 1
    kText,    // text, without its quotes
    kName,    // alias, text: a variable, or a word such as `off`
    kIndex,   // parts: what has elements, then one to three indices (a text for a collection)
    kField,   // parts[0] is what has it; text: its name
    kCall,    // alias, text: an instruction; parts: arguments
    kUnary,   // text: "-" or "!"; parts[0]
    kBinary,  // text: or and xor != == >= <= > < - + % / *; parts
    kBraces,  // parts: the fields' values
  };
  Kind kind{};
  int line = 0;
  int column = 0;  // from 1, in its line
  std::string alias;
  std::string text;
  double number = 0.0;
  std::vector<Expression> parts;

  // The resolver's.
  Type type;
  bool is_place = false;    // can be assigned to or passed by reference
  bool is_unknown = false;  // of a library that is not there, or found to be wrong: it has no type
  Reference reference;
};

/// One line of a program. Blank lines and comments are left out.
struct Line {
  enum class Kind {
    kAssign,          // expressions: one or more places, then the value
    kInstruction,     // expressions: the expression whose value is dropped
    kCall,            // alias, program; expressions: arguments
    kTaskCreate,      // alias, program; expressions: name, priority, arguments...
    kTaskCreateSync,  // alias, program; expressions: name, period, overrun flag, arguments...
    kIf,              // expressions: condition
    kElseIf,          // expressions: condition
    kElse,
    kEndIf,
    kWhile,  // expressions: condition
    kEndWhile,
    kDo,
    kUntil,  // expressions: condition
    kFor,    // expressions: counter, first, last, and the step when it is given
    kEndFor,
    kSwitch,  // expressions: selector
    kCase,    // expressions: values
    kDefault,
    kBreak,
    kEndSwitch,
    kReturn,
    kEnd,  // the program's last line
  };
  Kind kind{};
  int line = 0;  // of the file
  int column = 0;
  std::vector<Expression> expressions;
  std::string alias;
  std::string program;
  bool is_shorthand = false;  // `?value` of s8, which prints

  // Of a line of a block (kIf to kEndSwitch), indices into Program::lines. The same index as its own where
  // there is no other.
  std::size_t open = 0;   // the line that opens the block: kIf, kWhile, kDo, kFor, kSwitch
  std::size_t next = 0;   // the block's next kElseIf, kElse, kCase, kDefault, or its last line
  std::size_t close = 0;  // the block's last line: kEndIf, kEndWhile, kUntil, kEndFor, kEndSwitch

  // The resolver's, of kCall and the creation of tasks.
  int called_library = -1;  // as Reference::library
  int called_program = -1;  // index of that application's programs
};

}  // namespace val3
