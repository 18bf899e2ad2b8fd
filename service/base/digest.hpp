#pragma once

#include <string>

namespace cell {

/// SHA-256 as 64 hexadecimal digits.
std::string sha256_hex(const std::string& bytes);

}  // namespace cell
