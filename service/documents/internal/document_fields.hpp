#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "service/base/json_figures.hpp"
#include "service/documents/carried_json.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/words.hpp"

/// A document is a struct that declares each field once, by `visit`, with its key and its member. The writer
/// and the reader walk that declaration, so a key is written in one place. Only the .cpp files of the
/// documents include this header.
namespace cell {

/// Writes the fields of one object, in the order of their declaration. A figure that is no number is null.
class FieldWriter {
 public:
  explicit FieldWriter(Json& object) : object_(object) {}

  template <class Value>
  void operator()(const char* key, const Value& value) {
    write(slot(key), value);
  }
  /// A field that is left out when it has no value.
  template <class Value>
  void if_set(const char* key, const std::optional<Value>& value) {
    if (value) write(slot(key), *value);
  }

  static void write(Json& to, bool value);
  static void write(Json& to, int value);
  static void write(Json& to, std::int64_t value);
  static void write(Json& to, std::uint64_t value);
  static void write(Json& to, double value);
  static void write(Json& to, const std::string& value);
  static void write(Json& to, const CarriedJson& value);
  template <class Enumeration>
    requires std::is_enum_v<Enumeration>
  static void write(Json& to, Enumeration value) {
    write(to, std::string(word_of(value)));
  }
  template <class T>
  static void write(Json& to, const Carried<T>& value) {
    write(to, CarriedJson{value.text});
  }
  template <class T>
  static void write(Json& to, const std::optional<T>& value) {
    if (value) write(to, *value);  // else it stays null
  }
  template <class T>
  static void write(Json& to, const std::vector<T>& values) {
    write_list(to, values);
  }
  template <class T, std::size_t count>
  static void write(Json& to, const std::array<T, count>& values) {
    write_list(to, values);
  }
  static void write(Json& to, const std::map<std::string, std::string>& texts);
  template <class Document>
    requires std::is_class_v<Document>
  static void write(Json& to, const Document& document) {
    FieldWriter fields(as_object(to));
    Document::visit(document, fields);
  }

 private:
  Json& slot(const char* key);
  static Json& as_object(Json& value);
  static Json& as_list(Json& value);
  static Json& appended(Json& list);

  template <class Values>
  static void write_list(Json& to, const Values& values) {
    Json& list = as_list(to);
    for (const auto& value : values) write(appended(list), value);
  }

  Json& object_;
};

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// What the reader does where a field is not there that is no std::optional.
enum class Absent {
  kIsRefused,
  kKeepsDefault,  // the document may be one that an older daemon stored
};

/// Reads the fields of one object. A std::optional member has no value where the field is null or not there.
/// DocumentError names the field that cannot be read.
class FieldReader {
 public:
  /// A value in the document and the way to it, for messages.
  struct Place {
    const Json& value;
    Absent absent = Absent::kIsRefused;
    const Place* parent = nullptr;
    const char* key = nullptr;  // in an object
    std::size_t index = 0;      // in an array
  };

  explicit FieldReader(const Place& object);

  template <class Value>
  void operator()(const char* key, Value& value) {
    const Json* found = find(key);
    if (!found) {
      if constexpr (!kIsOptional<Value>) may_be_absent(key);
      return;
    }
    if constexpr (!kIsOptional<Value>) {
      if (is_default(*found)) return;
    }
    read({*found, object_.absent, &object_, key}, value);
  }
  template <class Value>
  void if_set(const char* key, std::optional<Value>& value) {
    (*this)(key, value);
  }

  static void read(const Place& at, bool& value);
  static void read(const Place& at, int& value);
  static void read(const Place& at, std::int64_t& value);
  static void read(const Place& at, std::uint64_t& value);
  static void read(const Place& at, double& value);
  static void read(const Place& at, std::string& value);
  static void read(const Place& at, CarriedJson& value);
  template <class Enumeration>
    requires std::is_enum_v<Enumeration>
  static void read(const Place& at, Enumeration& value) {
    std::string word;
    read(at, word);
    for (const Enumeration known : kAllOf<Enumeration>) {
      if (word_of(known) != word) continue;
      value = known;
      return;
    }
    refuse_word(at, word);
  }
  static void read(const Place& at, std::map<std::string, std::string>& texts);
  template <class T>
  static void read(const Place& at, Carried<T>& value) {
    CarriedJson carried;
    read(at, carried);
    value.text = std::move(carried.text);
    read(at, value.value);
  }
  template <class T>
  static void read(const Place& at, std::optional<T>& value) {
    value.reset();
    if (is_null(at)) return;
    value = T{};
    read(at, *value);
  }
  /// Absent is no value, null an inner one that has none.
  template <class T>
  static void read(const Place& at, std::optional<std::optional<T>>& value) {
    read(at, value.emplace());
  }
  template <class T>
  static void read(const Place& at, std::vector<T>& values) {
    values.assign(size_of_list(at), T());
    for (std::size_t i = 0; i < values.size(); ++i) read(element(at, i), values[i]);
  }
  template <class T, std::size_t count>
  static void read(const Place& at, std::array<T, count>& values) {
    demand_size(at, count);
    for (std::size_t i = 0; i < count; ++i) read(element(at, i), values[i]);
  }
  template <class Document>
    requires std::is_class_v<Document>
  static void read(const Place& at, Document& document) {
    FieldReader fields(at);
    Document::visit(document, fields);
  }

 private:
  [[nodiscard]] const Json* find(const char* key) const;
  void may_be_absent(const char* key) const;
  [[nodiscard]] bool is_default(const Json& found) const;
  [[noreturn]] static void refuse_word(const Place& at, const std::string& word);
  static bool is_null(const Place& at);
  static std::size_t size_of_list(const Place& at);
  static void demand_size(const Place& at, std::size_t count);
  static Place element(const Place& list, std::size_t index);

  const Place& object_;
};

/// The JSON value that `write` fills, as text.
std::string text_written(const std::function<void(Json&)>& write);

/// Hands the text's JSON value to `read`; NotJson when the text is none.
void parse_and_read(std::string_view text, const std::function<void(const Json&)>& read);

template <class Document>
std::string written(const Document& document) {
  return text_written([&document](Json& json) { FieldWriter::write(json, document); });
}

template <class Document>
Document document_from(std::string_view text, Absent absent) {
  Document document;
  parse_and_read(text, [&](const Json& json) { FieldReader::read({json, absent}, document); });
  return document;
}

}  // namespace cell
