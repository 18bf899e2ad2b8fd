#include "service/documents/internal/document_fields.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

namespace cell {
namespace {

/// The way from the root to a value, RFC 6901. No key of ours has a character that would be escaped.
std::string pointer_to(const FieldReader::Place& at) {
  if (!at.parent) return {};
  return pointer_to(*at.parent) + "/" + (at.key ? std::string(at.key) : std::to_string(at.index));
}

[[noreturn]] void refuse(const FieldReader::Place& at, const char* expected) {
  throw DocumentError(pointer_to(at),
                      std::string("expected ") + expected + ", found " + at.value.type_name());
}

/// A whole number that this type holds; 12.0 is one.
template <class Whole>
Whole whole_number_at(const FieldReader::Place& at) {
  const Json& value = at.value;
  if (!value.is_number()) refuse(at, "a number");
  bool is_held = false;
  if (value.is_number_unsigned()) {
    is_held = std::in_range<Whole>(value.get<std::uint64_t>());
  } else if (value.is_number_integer()) {
    is_held = std::in_range<Whole>(value.get<std::int64_t>());
  } else {
    const auto figure = value.get<double>();
    const double above = std::ldexp(1.0, std::numeric_limits<Whole>::digits);  // the first that is too large
    const double least = std::is_signed_v<Whole> ? -above : 0.0;
    is_held = figure >= least && figure < above && figure == std::trunc(figure);
  }
  if (!is_held) throw DocumentError(pointer_to(at), "is no whole number of the size that is wanted");
  return value.get<Whole>();
}

}  // namespace

void FieldWriter::write(Json& to, bool value) { to = value; }
void FieldWriter::write(Json& to, int value) { to = value; }
void FieldWriter::write(Json& to, std::int64_t value) { to = value; }
void FieldWriter::write(Json& to, std::uint64_t value) { to = value; }
void FieldWriter::write(Json& to, double value) { to = number(value); }
void FieldWriter::write(Json& to, const std::string& value) { to = value; }

void FieldWriter::write(Json& to, const CarriedJson& value) {
  if (!value.text.empty()) to = Json::parse(value.text);
}

void FieldWriter::write(Json& to, const std::map<std::string, std::string>& texts) {
  Json& object = as_object(to);
  for (const auto& [key, text] : texts) object[key] = text;
}

Json& FieldWriter::slot(const char* key) { return object_[key]; }

Json& FieldWriter::as_object(Json& value) { return value = Json::object(); }

Json& FieldWriter::as_list(Json& value) { return value = Json::array(); }

Json& FieldWriter::appended(Json& list) { return list.emplace_back(nullptr); }

FieldReader::FieldReader(const Place& object) : object_(object) {
  if (!object.value.is_object()) refuse(object, "an object");
}

const Json* FieldReader::find(const char* key) const {
  const auto found = object_.value.find(key);
  return found == object_.value.end() ? nullptr : &*found;
}

void FieldReader::may_be_absent(const char* key) const {
  if (object_.absent == Absent::kIsRefused)
    throw DocumentError(pointer_to({object_.value, object_.absent, &object_, key}), "is missing");
}

bool FieldReader::is_default(const Json& found) const {
  return found.is_null() && object_.absent == Absent::kKeepsDefault;
}

void FieldReader::read(const Place& at, bool& value) {
  if (!at.value.is_boolean()) refuse(at, "true or false");
  value = at.value.get<bool>();
}

void FieldReader::read(const Place& at, int& value) { value = whole_number_at<int>(at); }
void FieldReader::read(const Place& at, std::int64_t& value) { value = whole_number_at<std::int64_t>(at); }
void FieldReader::read(const Place& at, std::uint64_t& value) { value = whole_number_at<std::uint64_t>(at); }
void FieldReader::read(const Place& at, double& value) {
  if (!at.value.is_number()) refuse(at, "a number");
  value = at.value.get<double>();
}

void FieldReader::read(const Place& at, std::string& value) {
  if (!at.value.is_string()) refuse(at, "a text");
  value = at.value.get_ref<const std::string&>();
}

void FieldReader::read(const Place& at, CarriedJson& value) { value.text = text_of(at.value); }

void FieldReader::read(const Place& at, std::map<std::string, std::string>& texts) {
  if (!at.value.is_object()) refuse(at, "an object");
  for (const auto& [key, text] : at.value.items()) read({text, at.absent, &at, key.c_str()}, texts[key]);
}

void FieldReader::refuse_word(const Place& at, const std::string& word) {
  throw DocumentError(pointer_to(at), "'" + word + "' is not a word of this version of touchcal");
}

bool FieldReader::is_null(const Place& at) { return at.value.is_null(); }

std::size_t FieldReader::size_of_list(const Place& at) {
  if (!at.value.is_array()) refuse(at, "an array");
  return at.value.size();
}

void FieldReader::demand_size(const Place& at, std::size_t count) {
  if (size_of_list(at) != count) refuse(at, ("an array of " + std::to_string(count)).c_str());
}

FieldReader::Place FieldReader::element(const Place& list, std::size_t index) {
  return {list.value[index], list.absent, &list, nullptr, index};
}

std::string text_written(const std::function<void(Json&)>& write) {
  Json json;
  write(json);
  return text_of(json);
}

void parse_and_read(std::string_view text, const std::function<void(const Json&)>& read) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw NotJson();
  read(json);
}

}  // namespace cell
