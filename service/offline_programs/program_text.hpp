#pragma once

#include <map>
#include <string>
#include <vector>

#include "service/offline_programs/program_tokens.hpp"
#include "service/offline_programs/xml_text.hpp"

namespace cell {

struct ProgramLine {
  int number = 0;    // in the file, from 1
  std::string text;  // as VAL3, without XML's escapes
};

/// A program of a .pgx file: its lines, and which names are its own.
struct ProgramText {
  std::string name;
  std::string file;
  std::vector<std::string> parameters;                        // in their order
  std::map<std::string, std::string, std::less<>> own_types;  // of parameters and locals, by their names
  std::vector<ProgramLine> lines;
};

/// Longer lines no controller stores; the longest in public programs has 467 bytes.
inline constexpr std::size_t kProgramLineBytesMax = 2048;

/// The programs of a file of s5 to s8. Throws ConfigError with the line: no program file, a line longer than
/// kProgramLineBytesMax.
std::vector<ProgramText> read_program_text(const XmlText& xml);

}  // namespace cell
