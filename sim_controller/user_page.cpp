#include "sim_controller/user_page.hpp"

#include <algorithm>
#include <string_view>

namespace sim {
namespace {

constexpr char32_t kUnreadable = U'?';

/// Takes one character off the front of UTF-8; what is none is a question mark, a byte long.
char32_t take_character(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const int more = lead < 0x80   ? 0
                   : lead < 0xC2 ? -1
                   : lead < 0xE0 ? 1
                   : lead < 0xF0 ? 2
                   : lead < 0xF5 ? 3
                                 : -1;
  if (more <= 0 || text.size() <= static_cast<std::size_t>(more)) {
    text.remove_prefix(1);
    return more == 0 ? static_cast<char32_t>(lead) : kUnreadable;
  }
  char32_t code = lead & (0x3Fu >> more);
  for (int i = 1; i <= more; ++i) {
    const auto byte = static_cast<unsigned char>(text[static_cast<std::size_t>(i)]);
    if ((byte & 0xC0u) != 0x80u) {
      text.remove_prefix(1);
      return kUnreadable;
    }
    code = (code << 6) | (byte & 0x3Fu);
  }
  text.remove_prefix(static_cast<std::size_t>(more) + 1);
  return code;
}

void append_character(std::string& text, char32_t code) {
  const auto byte = [&text](char32_t value) { text += static_cast<char>(static_cast<unsigned char>(value)); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | (code >> 6));
    byte(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    byte(0xE0 | (code >> 12));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xF0 | (code >> 18));
    byte(0x80 | ((code >> 12) & 0x3F));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

}  // namespace

void UserPage::clear() {
  for (auto& row : cells_) row.fill(U' ');
  column_ = row_ = 0;
  ++changes_;
}

void UserPage::go_to(int column, int row) {
  const auto modulo = [](int value, int size) { return (value % size + size) % size; };
  column_ = modulo(column, kColumns);
  row_ = modulo(row, kRows);
}

void UserPage::new_line() {
  column_ = 0;
  if (++row_ < kRows) return;
  row_ = kRows - 1;
  std::move(cells_.begin() + 1, cells_.end(), cells_.begin());
  cells_.back().fill(U' ');
}

void UserPage::put(const std::string& text, bool ends_line) {
  for (std::string_view rest = text; !rest.empty();) {
    const char32_t code = take_character(rest);
    if (code == U'\n') {
      new_line();
      continue;
    }
    if (column_ == kColumns) new_line();
    cells_[static_cast<std::size_t>(row_)][static_cast<std::size_t>(column_++)] = code < U' ' ? U' ' : code;
  }
  if (ends_line) new_line();
  ++changes_;
}

void UserPage::set_element(const std::string& name, const std::string& text) {
  if (!elements_.contains(name) && elements_.size() >= kElementsMax) return;
  elements_[name] = text;
  ++changes_;
}

std::string UserPage::line(int row) const {
  const auto& cells = cells_.at(static_cast<std::size_t>(row));
  const auto end = std::find_if(cells.rbegin(), cells.rend(), [](char32_t cell) { return cell != U' '; });
  std::string text;
  std::for_each(cells.begin(), end.base(), [&text](char32_t cell) { append_character(text, cell); });
  return text;
}

std::string UserPage::text() const {
  std::string all;
  for (int row = 0; row < kRows; ++row) all += line(row) + '\n';
  return all;
}

void UserPage::press(int code) {
  last_key_ = code;
  pressed_.insert(code);
}

std::optional<int> UserPage::take_key() {
  const std::optional<int> key = shown_ ? last_key_ : std::nullopt;
  last_key_.reset();
  return key;
}

}  // namespace sim
