#include "service/base/terminal_text.hpp"

#include <cstddef>
#include <cstdint>

namespace cell {
namespace {

/// The character that begins a text, and its bytes; of no bytes where that is no UTF-8.
struct FirstCharacter {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

FirstCharacter first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return {};
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kSmallest[]{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kSmallest[bytes] || code > 0x10ffff || is_surrogate) return {};
  return {code, bytes};
}

bool steers(std::uint32_t code) {
  if (code == '\n') return false;
  const bool is_control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool is_mark = code == 0x61c || code == 0x200e || code == 0x200f;
  const bool is_embedding = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  const bool is_separator = code == 0x2028 || code == 0x2029;
  return is_control || is_mark || is_embedding || is_separator;
}

}  // namespace

std::string terminal_text(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const FirstCharacter first = first_character(text);
    if (first.bytes == 0) {
      safe += '?';
      text.remove_prefix(1);
      continue;
    }
    if (steers(first.code)) {
      safe += '?';
    } else {
      safe += text.substr(0, first.bytes);
    }
    text.remove_prefix(first.bytes);
  }
  return safe;
}

}  // namespace cell
