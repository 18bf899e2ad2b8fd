#pragma once

#include <string>

namespace cell {

/// SHA-256 as 64 hexadecimal digits. Throws std::bad_alloc where there is no memory for it: an empty digest
/// in a chain or beside a document would be damage.
std::string sha256_hex(const std::string& bytes);

}  // namespace cell
