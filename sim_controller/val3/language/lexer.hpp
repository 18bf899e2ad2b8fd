#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/program/finding.hpp"

namespace val3 {

struct Token {
  enum class Kind { kWord, kNumber, kText, kSign, kEndOfLine };
  Kind kind = Kind::kEndOfLine;
  std::string_view text;  // of the line; a text without its quotes, a word with the $ of an add-on
  double number = 0.0;
  int column = 0;  // from 1, in bytes
};

/// What is wrong with a line of a program.
struct LineProblem {
  std::string_view rule;  // of syntax_rules
  int column = 0;
  std::string what;
  std::string remedy;
  Severity severity = Severity::kError;
};

/// The tokens of one line, kEndOfLine last; they look into `line`. A text longer than kTextBytesMax is told
/// in `warning`. The first character that no token begins with is a problem; what stands before it is kept.
std::optional<LineProblem> tokens_of(std::string_view line, std::vector<Token>& tokens,
                                     std::optional<LineProblem>& warning);

/// All words that cannot be names (language reference, 2.1).
bool is_keyword(std::string_view word);
/// The keyword that differs from the word in letter case only; empty when there is none.
std::string_view keyword_like(std::string_view word);

/// A text between quotes on s6: bytes of UTF-8 (manual 6, page 48).
inline constexpr std::size_t kTextBytesMax = 128;
/// A controller's own limit is not published; the longest line in public programs has 467 bytes.
inline constexpr std::size_t kLineBytesMax = 2048;

}  // namespace val3
