#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cell {

class JsonObject;

/// As short as it can be written without loss: 4, 0.5, 1e-09.
std::string plain_number(double number);

/// No length in mm, angle, speed, mass or deviation in a file is larger (100 m in mm): a larger
/// one is a typo or would overflow. A figure that may be larger has a range of its own.
inline constexpr double kNumberMax = 1e5;

/// Ends included.
struct NumberRange {
  double min = -kNumberMax;
  double max = kNumberMax;
};

inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{
    .min = 1e-12};  // nothing measurable is smaller, and its inverse is finite
inline constexpr NumberRange kNotNegative{.min = 0.0};

/// A JSON value and its place in the document. Every demand that is not met is a ConfigError with that place.
/// The document must outlive it.
class JsonValue {
 public:
  /// The root of a document; messages call it `source`.
  JsonValue(const std::string& source, const nlohmann::json& document);

  /// An object that may have these keys and no others.
  [[nodiscard]] JsonObject object(std::initializer_list<std::string_view> known_keys) const;
  /// A document whose "schema" is this one; the schema is looked at before the keys.
  [[nodiscard]] JsonObject document(std::string_view schema,
                                    std::initializer_list<std::string_view> known_keys) const;
  /// An object whose keys are the file's own names: each with its value.
  [[nodiscard]] std::vector<std::pair<std::string, JsonValue>> members() const;

  [[nodiscard]] std::vector<JsonValue> items(std::size_t count_min, std::size_t count_max) const;
  [[nodiscard]] double number(const NumberRange& range = kAnyNumber) const;
  [[nodiscard]] int integer(int min, int max) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;  // not empty, no control characters
  [[nodiscard]] bool is_text() const;      // for what may be a text or something else
  [[nodiscard]] bool is_null() const;      // for what may be unknown

  /// An array of exactly Count numbers, each at most kNumberMax in size.
  template <int Count>
  [[nodiscard]] Eigen::Matrix<double, Count, 1> numbers() const {
    Eigen::Matrix<double, Count, 1> values;
    read_numbers(values.data(), Count);
    return values;
  }

  /// Throws ConfigError at this place.
  [[noreturn]] void fail(const std::string& message) const;

  [[nodiscard]] const std::string& pointer() const { return pointer_; }

 private:
  friend class JsonObject;
  JsonValue(std::shared_ptr<const std::string> source, std::string pointer, const nlohmann::json& value);
  [[nodiscard]] JsonValue child(std::string_view key, const nlohmann::json& value) const;
  void read_numbers(double* values, std::size_t count) const;

  std::shared_ptr<const std::string> source_;
  std::string pointer_;
  const nlohmann::json* value_;
};

/// Whether the document says that it is of this schema; for files that exist in several versions.
bool has_schema(const nlohmann::json& document, std::string_view schema);

/// An object whose keys are all known. Asking for a key that was not declared is a std::logic_error.
class JsonObject {
 public:
  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] JsonValue at(std::string_view key) const;  // ConfigError when it is missing
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;

  /// The key `name` + "_mm".
  [[nodiscard]] double metres(std::string_view name, const NumberRange& range_mm = kAnyNumber) const;
  [[nodiscard]] std::optional<double> find_metres(std::string_view name, const NumberRange& range_mm) const;
  /// The key `name` + "_deg" or `name` + "_rad": one of them, not both.
  [[nodiscard]] double radians(std::string_view name) const;
  [[nodiscard]] std::optional<double> find_radians(std::string_view name,
                                                   const NumberRange& range = kAnyNumber) const;

  [[noreturn]] void fail(const std::string& message) const { self_.fail(message); }

 private:
  friend class JsonValue;
  JsonObject(JsonValue self, std::vector<std::string_view> known_keys);
  void demand_declared(std::string_view key) const;

  JsonValue self_;
  std::vector<std::string_view> known_keys_;
};

}  // namespace cell
