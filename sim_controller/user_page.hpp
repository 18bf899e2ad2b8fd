#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sim {

/// The user page of a pendant, as text: 14 lines of 40 columns under a title (manual 6, pages 67 to 71).
class UserPage {
 public:
  static constexpr int kColumns = 40;
  static constexpr int kRows = 14;

  UserPage() { clear(); }

  void show() { shown_ = true; }
  [[nodiscard]] bool shown() const { return shown_; }
  /// Blank, and the cursor at home. The title stays.
  void clear();
  /// Modulo the page's size.
  void go_to(int column, int row);
  /// UTF-8. Goes on in the next line at the right edge, and scrolls at the end.
  void put(const std::string& text, bool new_line);
  void set_title(const std::string& text) { title_ = text; }
  /// What an element of a page of HTML shows (s8), by "page.element.attribute"; kElementsMax of them.
  void set_element(const std::string& name, const std::string& text);
  [[nodiscard]] const std::map<std::string, std::string>& elements() const { return elements_; }
  static constexpr std::size_t kElementsMax = 1'000;

  [[nodiscard]] const std::string& title() const { return title_; }
  /// One line, without the blanks at its end.
  [[nodiscard]] std::string line(int row) const;
  /// All lines, each with its line break.
  [[nodiscard]] std::string text() const;
  /// Goes up with every change of title or lines.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }

  // ---- keys ----
  void press(int code);
  void release(int code) { pressed_.erase(code); }
  /// The last key that was pressed since the last call.
  std::optional<int> take_key();
  [[nodiscard]] bool is_pressed(int code) const { return pressed_.contains(code); }

 private:
  void new_line();

  std::array<std::array<char32_t, kColumns>, kRows> cells_{};
  std::string title_;
  std::map<std::string, std::string> elements_;
  int column_ = 0;
  int row_ = 0;
  bool shown_ = false;
  std::uint64_t changes_ = 0;
  std::optional<int> last_key_;
  std::set<int> pressed_;
};

}  // namespace sim
