#include "config/decimal_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string_view>
#include <system_error>

namespace cell {
namespace {

std::string_view without_sign(std::string_view text) { return text.starts_with('-') ? text.substr(1) : text; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_of_number(char c) { return is_digit(c) || c == '.' || c == 'e' || c == 'E' || c == '-' || c == '+'; }

}  // namespace

std::string refuse_integer(const std::string& text) {
  const std::string_view digits = without_sign(text);
  const bool is_octal = digits.size() > 1 && digits.starts_with('0');  // to who reads it with base 0
  if (!digits.empty() && !is_octal && std::ranges::all_of(digits, is_digit)) return {};
  return "wants a whole number in decimal digits" + std::string(is_octal ? " without a zero in front" : "") +
         ", not '" + text + "'";
}

std::string refuse_count64(const std::string& text) {
  if (std::string refusal = refuse_integer(text); !refusal.empty()) return refusal;
  std::uint64_t unused = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, unused);
  if (error == std::errc{} && rest == end) return {};
  return "wants a whole number from 0 to " + std::to_string(std::numeric_limits<std::uint64_t>::max()) +
         ", not '" + text + "'";
}

std::string refuse_number(const std::string& text) {
  double unused = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, unused);
  const bool is_read = rest == end && (error == std::errc{} || error == std::errc::result_out_of_range);
  if (is_read && std::ranges::all_of(text, is_of_number)) return {};
  return "wants a number in decimal digits, not '" + text + "'";
}

}  // namespace cell
