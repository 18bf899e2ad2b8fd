#pragma once

#include <string>

namespace val3 {

/// What is wrong with a file of a VAL3 application, and where.
struct Problem {
  std::string file;
  int line = 0;  // from 1; 0 when it concerns the whole file
  std::string text;

  [[nodiscard]] std::string message() const { return file + ":" + std::to_string(line) + ": " + text; }
};

}  // namespace val3
