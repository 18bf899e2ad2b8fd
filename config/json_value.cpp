#include "config/json_value.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

using nlohmann::json;

std::string kind_of(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::boolean:
      return "true or false";
    case json::value_t::string:
      return "a text";
    case json::value_t::array:
      return "an array";
    case json::value_t::object:
      return "an object";
    default:
      return "a number";
  }
}

std::string listed(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::string joined(std::string_view name, std::string_view suffix) {
  return std::string(name).append(suffix);
}

/// What to give in place of a number outside the range; the general bounds are told only to who broke them.
std::string wanted_number(double given, const NumberRange& range) {
  const bool over_zero = range.min == kPositive.min && given <= 0.0;
  if (given < range.min && range.max == kNumberMax && range.min != -kNumberMax)
    return over_zero ? "a number over 0" : "at least " + plain_number(range.min);
  if (given > range.max && range.min == -kNumberMax && range.max != kNumberMax)
    return "at most " + plain_number(range.max);
  return (over_zero ? "a number over 0, up to " : plain_number(range.min) + " to ") + plain_number(range.max);
}

}  // namespace

std::string plain_number(double number) {
  std::string text = json(number).dump();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

JsonValue::JsonValue(const std::string& source, const json& document)
    : JsonValue(std::make_shared<const std::string>(source), "", document) {}

JsonValue::JsonValue(std::shared_ptr<const std::string> source, std::string pointer, const json& value)
    : source_(std::move(source)), pointer_(std::move(pointer)), value_(&value) {}

JsonValue JsonValue::child(std::string_view key, const json& value) const {
  return {source_, pointer_ + pointer_step(key), value};
}

void JsonValue::fail(const std::string& message) const { throw ConfigError(*source_, pointer_, message); }

JsonObject JsonValue::object(std::initializer_list<std::string_view> known_keys) const {
  if (!value_->is_object()) fail("is " + kind_of(*value_) + "; give an object");
  JsonObject object(*this, known_keys);
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known_keys.begin(), known_keys.end(), key) == known_keys.end()) {
      child(key, value).fail("unknown key " + in_quotes(key) + "; known here: " + listed(known_keys));
    }
  }
  return object;
}

JsonObject JsonValue::document(std::string_view schema,
                               std::initializer_list<std::string_view> known_keys) const {
  if (!value_->is_object())
    fail("is " + kind_of(*value_) + "; give an object with \"schema\":\"" + std::string(schema) + '"');
  const auto found = value_->find("schema");
  if (found == value_->end()) fail("\"schema\" is missing; add \"schema\":\"" + std::string(schema) + '"');
  const JsonValue given = child("schema", *found);
  if (const std::string name = given.text(); name != schema) {
    given.fail("is " + in_quotes(name) + "; this program reads \"" + std::string(schema) + "\" here");
  }
  return object(known_keys);
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
  if (!value_->is_object()) fail("is " + kind_of(*value_) + "; give an object");
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& [key, value] : value_->items()) members.emplace_back(key, child(key, value));
  return members;
}

std::vector<JsonValue> JsonValue::items(std::size_t count_min, std::size_t count_max) const {
  if (!value_->is_array()) fail("is " + kind_of(*value_) + "; give an array");
  const std::size_t count = value_->size();
  if (count < count_min || count > count_max) {
    const bool exact = count_min == count_max;
    const std::string wanted = exact               ? std::to_string(count_min)
                               : count < count_min ? "at least " + std::to_string(count_min)
                                                   : "at most " + std::to_string(count_max);
    fail("wants " + wanted + " entries, has " + std::to_string(count) +
         (count < count_min ? "; add the missing ones" : "; remove the others"));
  }
  std::vector<JsonValue> items;
  items.reserve(count);
  for (std::size_t i = 0; i < count; ++i) items.push_back(child(std::to_string(i), (*value_)[i]));
  return items;
}

double JsonValue::number(const NumberRange& range) const {
  if (!value_->is_number()) fail("is " + kind_of(*value_) + "; give a finite number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("is not finite; give a finite number");
  if (number < range.min || number > range.max) {
    fail("is " + plain_number(number) + "; give " + wanted_number(number, range));
  }
  return number;
}

int JsonValue::integer(int min, int max) const {
  const double number = value_->is_number() ? value_->get<double>() : std::nan("");
  if (!(number >= min && number <= max) || number != std::floor(number)) {
    const std::string given = value_->is_number() ? plain_number(number) : kind_of(*value_);
    fail("is " + given + "; give a whole number from " + std::to_string(min) + " to " + std::to_string(max));
  }
  return static_cast<int>(number);
}

bool JsonValue::boolean() const {
  if (!value_->is_boolean()) fail("is " + kind_of(*value_) + "; give true or false");
  return value_->get<bool>();
}

bool JsonValue::is_null() const { return value_->is_null(); }

bool JsonValue::is_text() const { return value_->is_string(); }

std::string JsonValue::text() const {
  if (!value_->is_string()) fail("is " + kind_of(*value_) + "; give a text");
  std::string text = value_->get<std::string>();
  if (text.empty()) fail("is empty; give a text");
  if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20; })) {
    fail("has a control character in it; remove it");
  }
  return text;
}

void JsonValue::read_numbers(double* values, std::size_t count) const {
  const std::string wanted = "wants " + std::to_string(count) + " numbers";
  if (!value_->is_array()) fail("is " + kind_of(*value_) + "; " + wanted);
  if (value_->size() != count) {
    fail(wanted + ", has " + std::to_string(value_->size()) +
         (value_->size() < count ? "; add the missing ones" : "; remove the others"));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const json& value = (*value_)[i];
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    // The place of a number is put into words only where it is complained of: files have many.
    const bool is_right = number >= kAnyNumber.min && number <= kAnyNumber.max;
    values[i] = is_right ? number : child(std::to_string(i), value).number();
  }
}

JsonObject::JsonObject(JsonValue self, std::vector<std::string_view> known_keys)
    : self_(std::move(self)), known_keys_(std::move(known_keys)) {}

void JsonObject::demand_declared(std::string_view key) const {
  if (std::find(known_keys_.begin(), known_keys_.end(), key) == known_keys_.end()) {
    throw std::logic_error("the key " + std::string(key) + " is read but not declared");
  }
}

bool JsonObject::has(std::string_view key) const {
  demand_declared(key);
  return self_.value_->contains(key);
}

std::optional<JsonValue> JsonObject::find(std::string_view key) const {
  demand_declared(key);
  const auto found = self_.value_->find(key);
  if (found == self_.value_->end()) return std::nullopt;
  return self_.child(key, *found);
}

JsonValue JsonObject::at(std::string_view key) const {
  const std::optional<JsonValue> value = find(key);
  if (!value) fail('"' + std::string(key) + "\" is missing; add it");
  return *value;
}

double JsonObject::metres(std::string_view name, const NumberRange& range_mm) const {
  return calib::metres_from_mm(at(joined(name, "_mm")).number(range_mm));
}

std::optional<double> JsonObject::find_metres(std::string_view name, const NumberRange& range_mm) const {
  if (!has(joined(name, "_mm"))) return std::nullopt;
  return metres(name, range_mm);
}

double JsonObject::radians(std::string_view name) const {
  const std::optional<double> angle = find_radians(name);
  if (!angle)
    fail('"' + joined(name, "_deg") + "\" is missing; add it (or \"" + joined(name, "_rad") + "\")");
  return *angle;
}

std::optional<double> JsonObject::find_radians(std::string_view name, const NumberRange& range) const {
  const auto in_degrees = find(joined(name, "_deg"));
  const auto in_radians = find(joined(name, "_rad"));
  if (in_degrees && in_radians) {
    in_radians->fail("the angle is also given as \"" + joined(name, "_deg") + "\"; keep one of them");
  }
  if (in_degrees) return calib::radians_from_degrees(in_degrees->number(range));
  if (in_radians) return in_radians->number(range);
  return std::nullopt;
}

bool has_schema(const nlohmann::json& document, std::string_view schema) {
  return document.is_object() && document.contains("schema") && document.at("schema") == schema;
}

}  // namespace cell
