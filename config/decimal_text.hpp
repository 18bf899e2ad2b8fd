#pragma once

#include <string>

namespace cell {

/// Numbers on a command line are written in decimal digits: no hexadecimal or octal ones, no separators, no
/// "inf" and no "nan". Each returns why a text is none, in words, or nothing where it is one: what a
/// validator of CLI11 returns. Other bounds are not looked at.
std::string refuse_integer(const std::string& text);  // 12, -3
std::string refuse_count64(const std::string& text);  // 12, not -3, nor more than 64 bits hold
std::string refuse_number(const std::string& text);   // 12, -0.5, 1e-3

}  // namespace cell
