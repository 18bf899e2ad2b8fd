#include "config/config_error.hpp"

#include <algorithm>
#include <utility>

namespace cell {
namespace {

constexpr std::size_t kQuotedLengthMax = 60;

/// Keys and paths come from outside: a line break in one must not make two lines of a message.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

std::string sentence(const std::string& source, const std::string& pointer, const std::string& message) {
  return source + ": " + (pointer.empty() ? "" : pointer + ": ") + message;
}

}  // namespace

ConfigError::ConfigError(std::string source, std::string pointer, std::string message)
    : std::runtime_error(one_line(sentence(source, pointer, message))),
      source_(std::move(source)),
      pointer_(std::move(pointer)),
      message_(one_line(std::move(message))) {}

std::string in_quotes(const std::string& text) {
  if (text.size() <= kQuotedLengthMax) return '"' + text + '"';
  std::size_t end = kQuotedLengthMax;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;  // not inside a character
  return '"' + text.substr(0, end) + "...\"";
}

}  // namespace cell
