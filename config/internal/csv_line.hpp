#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace cell {

/// Without spaces, tabs and carriage returns at its ends.
std::string_view trimmed(std::string_view text);
/// The first line, trimmed.
std::string_view first_line(std::string_view text);

/// One line of a CSV without quotes, with complaints that name it: ConfigError "SOURCE: line N: ...".
class CsvLine {
 public:
  /// `source` must outlive it.
  CsvLine(const std::string& source, std::size_t number) : source_(source), number_(number) {}

  [[noreturn]] void fail(const std::string& message) const;

  /// Exactly `count` cells, each trimmed. `what`: what they hold, for the complaint.
  template <std::size_t count>
  [[nodiscard]] std::array<std::string_view, count> split(std::string_view text,
                                                          std::string_view what) const {
    std::array<std::string_view, count> cells;
    split_into(text, what, cells);
    return cells;
  }
  [[nodiscard]] int integer(std::string_view text, std::string_view what, int min, int max) const;
  /// A number of at most kNumberMax in size.
  [[nodiscard]] double number(std::string_view text, const std::string& what) const;
  /// The same. `joint`: index, 0 to 5.
  [[nodiscard]] double joint(std::string_view text, int joint) const;

 private:
  void split_into(std::string_view text, std::string_view what, std::span<std::string_view> cells) const;

  const std::string& source_;
  std::size_t number_;
};

/// Behind a byte order mark and the lines of '#' at its beginning.
std::string_view without_remarks(std::string_view text);

/// Gives each line behind the header to `take`, trimmed; empty ones are left out. ConfigError unless the
/// first one that is no remark is `header`. The last line, for what is missing behind it.
CsvLine take_csv_lines(const std::string& source, std::string_view bytes, std::string_view header,
                       const std::function<void(const CsvLine& line, std::string_view text)>& take);

}  // namespace cell
