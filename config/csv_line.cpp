#include "config/internal/csv_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/config_error.hpp"
#include "config/json_value.hpp"

namespace cell {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view first_line(std::string_view text) { return trimmed(text.substr(0, text.find('\n'))); }

void CsvLine::fail(const std::string& message) const {
  throw ConfigError(source_, "", "line " + std::to_string(number_) + ": " + message);
}

void CsvLine::split_into(std::string_view text, std::string_view what,
                         std::span<std::string_view> cells) const {
  std::size_t count = 0;
  for (std::size_t begin = 0; begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (count < cells.size()) cells[count] = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (count == cells.size()) return;
  fail("wants " + std::string(what) + ", has " + std::to_string(count) + " values; separate " +
       std::to_string(cells.size()) + " values by commas");
}

int CsvLine::integer(std::string_view text, std::string_view what, int min, int max) const {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number < min || number > max) {
    fail(std::string(what) + " is " + in_quotes(std::string(text)) + "; give a whole number from " +
         std::to_string(min) + " to " + std::to_string(max));
  }
  return number;
}

double CsvLine::number(std::string_view text, const std::string& what) const {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number))
    fail(what + " is " + in_quotes(std::string(text)) + "; give a finite number");
  if (std::abs(number) > kNumberMax) {
    fail(what + " is " + plain_number(number) + "; give " + plain_number(-kNumberMax) + " to " +
         plain_number(kNumberMax));
  }
  return number;
}

double CsvLine::joint(std::string_view text, int joint) const {
  return number(text, "joint " + std::to_string(joint + 1));
}

std::string_view without_remarks(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of spreadsheets
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (text.starts_with('#')) {
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return text;
}

CsvLine take_csv_lines(const std::string& source, std::string_view bytes, std::string_view header,
                       const std::function<void(const CsvLine& line, std::string_view text)>& take) {
  const std::string_view behind = without_remarks(bytes);
  const std::string_view remarks = bytes.substr(0, bytes.size() - behind.size());
  std::size_t line_number = 1 + static_cast<std::size_t>(std::ranges::count(remarks, '\n'));
  bytes = behind;
  if (first_line(bytes) != header)
    CsvLine(source, line_number).fail("the header is missing; begin with " + std::string(header));
  for (std::size_t line_break = bytes.find('\n'); line_break != std::string_view::npos;) {
    const std::size_t begin = line_break + 1;
    line_break = bytes.find('\n', begin);
    const std::string_view text = trimmed(bytes.substr(begin, line_break - begin));  // npos: to the end
    ++line_number;
    if (!text.empty()) take(CsvLine(source, line_number), text);
  }
  return {source, line_number};
}

}  // namespace cell
