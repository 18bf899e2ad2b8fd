#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "service/documents/words.hpp"

namespace cell {

/// Writes the fields of one object as FieldWriter does, straight into a text: for a document that has many
/// thousands of them, where a JSON value each costs more than what it tells. The text is the same but for
/// digits of a number that any reader takes for the same double.
class FieldText {
 public:
  /// Appends the object with all that `document` declares.
  template <class Document>
  static void append(const Document& document, std::string& text) {
    FieldText fields(text);
    text += '{';
    Document::visit(document, fields);
    text += '}';
  }

  template <class Value>
  void operator()(const char* key, const Value& value) {
    if (!is_first_) text_ += ',';
    is_first_ = false;
    text_.append("\"").append(key).append("\":");
    write(value);
  }
  template <class Value>
  void if_set(const char* key, const std::optional<Value>& value) {
    if (value) (*this)(key, *value);
  }

 private:
  explicit FieldText(std::string& text) : text_(text) {}

  void write(std::same_as<bool> auto value) { text_ += value ? "true" : "false"; }
  void write(double value);
  void write(std::string_view value);
  void write(const std::string& value) { write(std::string_view(value)); }
  template <class Enumeration>
    requires std::is_enum_v<Enumeration>
  void write(Enumeration value) {
    write(word_of(value));
  }
  template <class T>
  void write(const std::optional<T>& value) {
    if (value)
      write(*value);
    else
      text_ += "null";
  }
  template <class T, std::size_t count>
  void write(const std::array<T, count>& values) {
    char before = '[';
    for (const T& value : values) {
      text_ += before;
      write(value);
      before = ',';
    }
    text_ += ']';
  }

  std::string& text_;
  bool is_first_ = true;
};

}  // namespace cell
