// Strings: counted in characters of UTF-8, cut at 128 bytes (manual 6, pages 48 to 55).
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "sim_controller/val3/machine/builtins.hpp"

namespace val3 {
namespace {

constexpr std::size_t kStringBytesMax = 128;

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

/// Bytes up to the n-th character, or all of them.
std::size_t bytes_of(std::string_view text, std::size_t characters) {
  std::size_t at = 0;
  for (std::size_t left = characters; at < text.size(); ++at)
    if (begins_character(text[at]) && left-- == 0) break;
  return at;
}

std::size_t characters_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string cut(std::string text) {
  if (text.size() <= kStringBytesMax) return text;
  std::size_t end = kStringBytesMax;
  while (end > 0 && !begins_character(text[end])) --end;
  text.resize(end);
  return text;
}

std::size_t whole(double number, const char* what) {
  if (!(number >= 0.0)) throw RunFailure(kErrorParameter, std::string(what) + " is negative");
  constexpr double kMax = 1e9;
  return static_cast<std::size_t>(std::min(number, kMax));
}

/// `format` is "width.decimals". The decimals' trailing zeros are blanks.
std::string formatted(const std::string& format, double number) {
  constexpr int kDigitsMax = 40;
  int width = 0;
  int decimals = 0;
  const auto read = [&](std::string_view digits, int& value) {
    if (digits.empty()) return;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || value < 0 || value > kDigitsMax)
      throw RunFailure(kErrorParameter, "'" + format + "' is no format of a number");
  };
  const std::size_t point = std::min(format.find('.'), format.size());
  read(std::string_view(format).substr(0, point), width);
  if (point < format.size()) read(std::string_view(format).substr(point + 1), decimals);
  std::array<char, 400> text{};
  const int length = std::snprintf(text.data(), text.size(), "%*.*f", width, decimals, number);
  std::string result(text.data(), static_cast<std::size_t>(std::max(0, length)));
  if (decimals > 0)
    for (std::size_t at = result.size(); at > 0 && result[at - 1] == '0'; --at) result[at - 1] = ' ';
  return cut(std::move(result));
}

bool begins_number(std::string_view text) {
  std::size_t at = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
  if (at < text.size() && text[at] == '.') ++at;
  return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

/// Reads a number in front of a text; what is left begins with the next number.
std::string to_number(Context&, const std::string& text, Out<double> number, Out<bool> ok) {
  std::string_view rest = text;
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  ok.value() = begins_number(rest);
  if (!ok.value()) return text;
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double value = 0.0;
  const auto end =
      std::from_chars(rest.data(), rest.data() + rest.size(), value, std::chars_format::fixed).ptr;
  number.value() = value;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  while (!rest.empty() && !begins_number(rest)) rest.remove_prefix(1);
  return std::string(rest);
}

std::string middle(const std::string& text, double count, double position) {
  const std::size_t from = bytes_of(text, whole(position, "a position"));
  const std::string rest = text.substr(from);
  return rest.substr(0, bytes_of(rest, whole(count, "a count")));
}

std::string right_of(Context&, const std::string& text, double count) {
  const std::size_t wanted = whole(count, "a count");
  const std::size_t all = characters_of(text);
  return text.substr(bytes_of(text, all - std::min(wanted, all)));
}

std::string without(Context&, const std::string& text, double count, double position) {
  const std::size_t from = bytes_of(text, whole(position, "a position"));
  const std::string rest = text.substr(from);
  return text.substr(0, from) + rest.substr(bytes_of(rest, whole(count, "a count")));
}

std::string with(Context&, const std::string& text, const std::string& added, double position) {
  const std::size_t at = bytes_of(text, whole(position, "a position"));
  return cut(text.substr(0, at) + added + text.substr(at));
}

std::string replaced(Context&, const std::string& text, const std::string& by, double count,
                     double position) {
  const std::size_t from = bytes_of(text, whole(position, "a position"));
  if (from == text.size()) return text;
  const std::string rest = text.substr(from);
  return cut(text.substr(0, from) + by + rest.substr(bytes_of(rest, whole(count, "a count"))));
}

/// A code point as UTF-8; "" for none (manual 6, page 50).
std::string character(Context&, double code) {
  constexpr double kCodeMax = 0x10FFFF;
  if (!(code >= 1.0 && code <= kCodeMax)) return "";
  const auto point = static_cast<std::uint32_t>(code);
  if (point >= 0xD800 && point < 0xE000) return "";
  const auto byte = [](std::uint32_t bits) { return static_cast<char>(bits); };
  if (point < 0x80) return {byte(point)};
  if (point < 0x800) return {byte(0xC0U | point >> 6U), byte(0x80U | (point & 0x3FU))};
  if (point < 0x10000)
    return {byte(0xE0U | point >> 12U), byte(0x80U | (point >> 6U & 0x3FU)), byte(0x80U | (point & 0x3FU))};
  return {byte(0xF0U | point >> 18U), byte(0x80U | (point >> 12U & 0x3FU)),
          byte(0x80U | (point >> 6U & 0x3FU)), byte(0x80U | (point & 0x3FU))};
}

double code_of(Context&, const std::string& text, double position) {
  if (position < 0.0) return -1.0;
  const std::size_t at = bytes_of(text, whole(position, "a position"));
  if (at >= text.size()) return -1.0;
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return first;
  if (first < 0xE0U) return (first & 0x1FU) << 6U | (byte(1) & 0x3FU);
  if (first < 0xF0U) return (first & 0x0FU) << 12U | (byte(1) & 0x3FU) << 6U | (byte(2) & 0x3FU);
  return (first & 0x07U) << 18U | (byte(1) & 0x3FU) << 12U | (byte(2) & 0x3FU) << 6U | (byte(3) & 0x3FU);
}

}  // namespace

void define_texts(Builtins& list) {
  list.define<std::string, std::string, double>(
      "toString",
      [](Context&, const std::string& format, double number) { return formatted(format, number); });
  list.define<std::string, std::string, Out<double>, Out<bool>>("toNum", to_number);
  list.define<std::string, double>("chr", character);
  list.define<double, std::string, double>("asc", code_of);
  list.define<std::string, std::string, double>(
      "left", [](Context&, const std::string& text, double count) { return middle(text, count, 0.0); });
  list.define<std::string, std::string, double>("right", right_of);
  list.define<std::string, std::string, double, double>(
      "mid",
      [](Context&, const std::string& text, double count, double at) { return middle(text, count, at); });
  list.define<std::string, std::string, double, double>("delete", without);
  list.define<std::string, std::string, std::string, double>("insert", with);
  list.define<std::string, std::string, std::string, double, double>("replace", replaced);
  list.define<double, std::string, std::string>("find", [](Context&, const std::string& text,
                                                           const std::string& part) {
    const std::size_t at = text.find(part);
    return at == std::string::npos ? -1.0
                                   : static_cast<double>(characters_of(std::string_view(text).substr(0, at)));
  });
  list.define<double, std::string>(
      "len", [](Context&, const std::string& text) { return static_cast<double>(characters_of(text)); });
}

}  // namespace val3
