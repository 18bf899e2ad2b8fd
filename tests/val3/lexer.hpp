#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/val3/problem.hpp"

namespace val3 {

enum class TokenKind { kWord, kNumber, kText, kSign, kEndOfLine, kEnd };

struct Token {
  TokenKind kind{};
  std::string text;  // without quotes
  double number = 0.0;
  int line = 0;
};

/// The words and signs of a program's code, with one kEndOfLine behind each line and kEnd at the end;
/// comments are left out. `first_line` is that of the code in `file`. Throws Problem.
std::vector<Token> tokens_of(std::string_view code, const std::string& file, int first_line);

}  // namespace val3
