#pragma once

#include <string_view>
#include <vector>

#include "sim_controller/val3/program/application.hpp"

/// The table of instructions as it is written down; instructions.cpp makes Instruction of its rows.
namespace val3::instruction_table {

enum Flags : unsigned {
  kPlain = 0,
  kYields = 1,     // may switch to another task
  kBlocks = 2,     // the task waits in it
  kOnLibrary = 4,  // written alias:name(...)
};

inline constexpr Version kS5{5, 0, 0}, kS53{5, 3, 0}, kS6{6, 0, 0}, kS61{6, 1, 0}, kS64{6, 4, 0},
    kS7{7, 0, 0}, kS8{8, 0, 0};

/// A signature is its result and the types of its parameters: "string(string, num&, bool&)". `|` stands
/// between types of which any will do, `any` for all of them, `&` after a variable that is written, `[]`
/// after an array, `?` after a parameter that may be left out, `...` in place of parameters that no source
/// tells. "s6.4 " or "s7 " before it is the version that brought it, where it came after the instruction.
struct Row {
  std::string_view name;
  std::vector<std::string_view> signatures;
  int page5 = 0;  // 0: not in that manual
  int page6 = 0;
  unsigned flags = kPlain;
  Version since = kS5;
  std::string_view addon;
};

std::vector<Row> of_values();    // numbers, bits, strings, arrays
std::vector<Row> of_channels();  // inputs, outputs, sockets, user page
std::vector<Row> of_system();    // tasks, libraries, the controller
std::vector<Row> of_motion();    // geometry, motion, latch, options, add-ons

}  // namespace val3::instruction_table
