#include "config/strict_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "config/config_error.hpp"

namespace cell {
namespace {

using nlohmann::json;

struct Complaint {
  std::string pointer;
  std::string message;
};

std::string line_and_column(std::string_view bytes, std::size_t position) {
  const std::string_view before = bytes.substr(0, std::min(position, bytes.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t last_break = before.rfind('\n');
  const std::size_t column =
      1 + (last_break == std::string_view::npos ? before.size() : before.size() - last_break - 1);
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Builds the document while it is read, so that depth and doubled keys are seen before memory is spent on
/// them.
class DocumentBuilder : public nlohmann::json_sax<json> {
 public:
  explicit DocumentBuilder(std::string_view bytes) : bytes_(bytes) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (open_.back()->contains(name)) {
      return refuse(pointer(), "the key " + in_quotes(name) + " is there twice; keep one");
    }
    keys_.back() = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& last_token,
                   const json::exception& error) override {
    const std::string where = line_and_column(bytes_, position == 0 ? 0 : position - 1);
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow) {
      return refuse(pointer(), where + ": the number " + last_token + " is too large; give a finite number");
    }
    if (last_token.empty() || position > bytes_.size()) {
      return refuse("", where + ": the JSON document ends too early; complete it");
    }
    return refuse("", where + ": not JSON near " + in_quotes(last_token) + "; correct it");
  }

  [[nodiscard]] const std::optional<Complaint>& complaint() const { return complaint_; }
  json take() { return std::move(root_); }

 private:
  bool refuse(std::string pointer, std::string message) {
    complaint_ = Complaint{std::move(pointer), std::move(message)};
    return false;
  }

  json* place(json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &parent.emplace(keys_.back(), std::move(value)).first.value();
  }

  template <class Value>
  bool add(Value&& value) {
    place(json(std::forward<Value>(value)));
    return true;
  }

  bool open(json value) {
    if (open_.size() == kJsonDepthMax) {
      return refuse("", "nested more than " + std::to_string(kJsonDepthMax) + " deep; flatten the document");
    }
    open_.push_back(place(std::move(value)));
    keys_.emplace_back();
    return true;
  }

  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  /// Of the innermost open object or array.
  [[nodiscard]] std::string pointer() const {
    std::string path;
    for (std::size_t level = 0; level + 1 < open_.size(); ++level) {
      path += open_[level]->is_array() ? pointer_step(std::to_string(open_[level]->size() - 1))
                                       : pointer_step(keys_[level]);
    }
    return path;
  }

  std::string_view bytes_;
  json root_;
  std::vector<json*> open_;        // from the root to the innermost
  std::vector<std::string> keys_;  // of each open object, the key that is being read
  std::optional<Complaint> complaint_;
};

}  // namespace

std::string pointer_step(std::string_view key) {
  std::string step = "/";
  for (const char c : key) {
    if (c == '~') {
      step += "~0";
    } else if (c == '/') {
      step += "~1";
    } else {
      step += c;
    }
  }
  return step;
}

json parse_strict_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes) {
  if (bytes.size() > size_max_bytes) {
    throw ConfigError(source, "",
                      "larger than " + std::to_string(size_max_bytes) + " bytes; make it smaller");
  }
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    throw ConfigError(source, "", "empty; give a JSON document");
  }
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") {  // the library would skip it without a word
    throw ConfigError(source, "", "begins with a byte order mark; save it as UTF-8 without one");
  }
  // The library takes a NUL for the end of its input and would not see what follows.
  if (const std::size_t nul = bytes.find('\0'); nul != std::string_view::npos) {
    throw ConfigError(source, "", line_and_column(bytes, nul) + ": a NUL byte; remove it");
  }
  DocumentBuilder builder(bytes);
  constexpr bool kNothingMayFollow = true;
  if (!json::sax_parse(bytes.begin(), bytes.end(), &builder, json::input_format_t::json, kNothingMayFollow)) {
    const Complaint complaint = builder.complaint().value_or(Complaint{"", "not JSON; correct it"});
    throw ConfigError(source, complaint.pointer, complaint.message);
  }
  return builder.take();
}

}  // namespace cell
