#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

/// A layer of our own on nlohmann::json, whose parser silently takes the last of two equal keys and has no
/// limit of size or nesting.
namespace cell {

/// Deeper nesting than this is refused: writing or destroying a very deep document would end the process.
inline constexpr int kJsonDepthMax = 32;

/// One JSON document (RFC 8259) or a ConfigError with line and column, or with the pointer of a doubled key.
/// Refused beyond what is not JSON: more than `size_max_bytes`, nothing at all, a byte order mark, NUL and
/// bytes after the document, invalid UTF-8, nesting over kJsonDepthMax, an object that names a key twice, a
/// number too large for a double. `source` is how messages call the bytes: a file's path, "request body".
nlohmann::json parse_strict_json(const std::string& source, std::string_view bytes,
                                 std::size_t size_max_bytes);

/// `key` as one step of a JSON pointer, with its leading slash (RFC 6901).
std::string pointer_step(std::string_view key);

}  // namespace cell
