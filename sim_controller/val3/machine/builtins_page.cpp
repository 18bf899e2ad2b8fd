// The user page, keys and the log (manual 6, pages 67 to 74).
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "sim_controller/val3/machine/builtins.hpp"
#include "sim_controller/val3/machine/tasks.hpp"

namespace val3 {
namespace {

/// A number on the page has three decimals (manual 6, page 69).
std::string shown(double number) {
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.3f", number);
  return {text.data(), static_cast<std::size_t>(std::min<int>(length, text.size() - 1))};
}

template <bool NewLine>
Nothing put_text(Context& context, const std::string& text) {
  context.system.put(text, NewLine);
  return {};
}
template <bool NewLine>
Nothing put_number(Context& context, double number) {
  context.system.put(shown(number), NewLine);
  return {};
}

double key(Context& context) { return static_cast<double>(context.system.take_key().value_or(-1)); }

double awaited_key(Context& context) {
  const auto pressed = context.system.take_key();
  if (!pressed) throw Wait{};
  return static_cast<double>(*pressed);
}

/// Columns of the page: a character takes one, whatever its bytes.
double columns_of(Context&, const std::string& text) {
  return static_cast<double>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

constexpr int kReturnKey = 270;
constexpr int kEscapeKey = 255;
constexpr int kBackspaceKey = 263;
constexpr int kFirstFunctionKey = 271;
constexpr int kLastFunctionKey = 278;
constexpr std::size_t kEditedBytesMax = 128;

std::string text_of(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}
std::string text_of(const std::string& text) { return text; }

void take_edited(const std::string& text, std::string& into) { into = text; }
/// What is no number leaves the variable.
void take_edited(const std::string& text, double& into) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(number)) into = number;
}

/// get(x): a person edits the variable, until Return, Esc or an F-key, which is the result; Esc leaves it as
/// it was (manual 6, page 69). A key a turn.
template <class T>
double edit(Context& context, const Out<T>& variable) {
  std::optional<std::string>& edited = context.task.edited;
  if (!edited) edited = text_of(variable.value());
  const auto key = context.system.take_key();
  if (!key) throw Wait{};
  const bool is_function = *key >= kFirstFunctionKey && *key <= kLastFunctionKey;
  if (*key == kReturnKey || *key == kEscapeKey || is_function) {
    if (*key != kEscapeKey) take_edited(*edited, variable.value());
    edited.reset();
    return static_cast<double>(*key);
  }
  if (*key == kBackspaceKey && !edited->empty()) edited->pop_back();
  const bool is_character = *key >= ' ' && *key < 0x7F;
  if (is_character && edited->size() < kEditedBytesMax) edited->push_back(static_cast<char>(*key));
  throw Wait{};
}

template <class T>
std::string element_text(const T& value) {
  if constexpr (std::is_same_v<T, bool>) return value ? "true" : "false";
  if constexpr (std::is_same_v<T, double>) return text_of(value);
  if constexpr (std::is_same_v<T, std::string>) return value;
}

/// userPageSet of s8: what an element of a page of HTML shows.
template <class T>
Nothing set_element(Context& context, const std::string& page, const std::string& element,
                    const std::string& attribute, const T& value) {
  context.system.set_page_element(page + "." + element + "." + attribute, element_text<T>(value));
  return {};
}

Nothing pop_up(Context& context, const std::string& text) {
  context.system.pop_up(text);
  return {};
}

/// There is one profile, and nobody but the pendant changes to "staubli".
double set_profile(Context&, const std::string& user, const std::string&) {
  constexpr double kUnknownProfile = -1.0;
  constexpr double kNotAllowed = -3.0;
  if (user == "staubli") return kNotAllowed;
  return user == "default" ? 0.0 : kUnknownProfile;
}

Nothing show(Context& context, bool fixed) {
  context.system.show_page(fixed);
  return {};
}

Nothing go_to(Context& context, double column, double row) {
  constexpr double kMax = 1e6;
  context.system.go_to(static_cast<int>(std::min(std::max(column, 0.0), kMax)),
                       static_cast<int>(std::min(std::max(row, 0.0), kMax)));
  return {};
}

Nothing clear(Context& context) {
  context.system.clear_page();
  return {};
}

Nothing set_title(Context& context, const std::string& text) {
  context.system.title(text);
  return {};
}

bool is_pressed(Context& context, double code) {
  return code >= 0.0 && code <= 1e6 && context.system.key_is_pressed(static_cast<int>(code));
}

/// The forms of s7 with a screen: all screens are the one page.
void define_screens(Builtins& list) {
  list.define<Nothing, Screen>("cls", [](Context& c, const Screen&) { return clear(c); });
  list.define<Nothing, Screen, double, double>(
      "gotoxy", [](Context& c, const Screen&, double column, double row) { return go_to(c, column, row); });
  list.define<Nothing, Screen, std::string>(
      "put", [](Context& c, const Screen&, const std::string& text) { return put_text<false>(c, text); });
  list.define<Nothing, Screen, double>(
      "put", [](Context& c, const Screen&, double number) { return put_number<false>(c, number); });
  list.define<Nothing, Screen, std::string>(
      "putln", [](Context& c, const Screen&, const std::string& text) { return put_text<true>(c, text); });
  list.define<Nothing, Screen, double>(
      "putln", [](Context& c, const Screen&, double number) { return put_number<true>(c, number); });
  list.define<Nothing, Screen, std::string>(
      "title", [](Context& c, const Screen&, const std::string& text) { return set_title(c, text); });
  list.define<double, Screen, std::string>(
      "getDisplayLen",
      [](Context& c, const Screen&, const std::string& text) { return columns_of(c, text); });
  list.define<Nothing, Screen, bool>("userPage",
                                     [](Context& c, const Screen&, bool fixed) { return show(c, fixed); });
  list.define<Nothing, Screen, double>("setTextMode",
                                       [](Context&, const Screen&, double) { return Nothing{}; });
  list.define<double, Screen>("getKey", [](Context& c, const Screen&) { return key(c); });
  list.define<double, Screen>("get", [](Context& c, const Screen&) { return awaited_key(c); });
  list.define<bool, Screen, double>(
      "isKeyPressed", [](Context& c, const Screen&, double code) { return is_pressed(c, code); });
}

}  // namespace

void define_page(Builtins& list) {
  list.define<Nothing>("userPage", [](Context& c) { return show(c, false); });
  list.define<Nothing, bool>("userPage", show);
  list.define<Nothing, std::string>("userPage",
                                    [](Context& c, const std::string&) { return show(c, false); });
  list.define<Nothing, Screen>("userPage", [](Context& c, const Screen&) { return show(c, false); });
  list.define<Nothing>("cls", clear);
  list.define<Nothing, double, double>("gotoxy", go_to);
  list.define<Nothing, std::string>("put", put_text<false>);
  list.define<Nothing, double>("put", put_number<false>);
  list.define<Nothing, std::string>("putln", put_text<true>);
  list.define<Nothing, double>("putln", put_number<true>);
  list.define<Nothing, std::string>("title", set_title);
  list.define<double, std::string>("getDisplayLen", columns_of);
  define_screens(list);
  list.define<double>("getKey", key);
  list.define<double>("get", awaited_key);
  list.define<bool, double>("isKeyPressed", is_pressed);
  list.define<double, Out<std::string>>("get", edit<std::string>);
  list.define<double, Out<double>>("get", edit<double>);
  list.define<Nothing, std::string>("popUpMsg", pop_up);
  list.define<Nothing, std::string>("userPageAlert", pop_up);
  list.define<Nothing, std::string, std::string, std::string, std::string>("userPageSet",
                                                                           set_element<std::string>);
  list.define<Nothing, std::string, std::string, std::string, double>("userPageSet", set_element<double>);
  list.define<Nothing, std::string, std::string, std::string, bool>("userPageSet", set_element<bool>);
  // How text looks is nothing that a page of characters shows.
  list.define<Nothing>("setTextMode", [](Context&) { return Nothing{}; });
  list.define<Nothing, double>("setTextMode", [](Context&, double) { return Nothing{}; });
  list.define<Nothing, std::string>("logMsg", [](Context& c, const std::string& text) {
    c.system.log(text);
    return Nothing{};
  });
  list.define<Nothing, std::string, double>("logMsg", [](Context& c, const std::string& text, double) {
    c.system.log(text);
    return Nothing{};
  });
  list.define<double, std::string, std::string>("setProfile", set_profile);
  list.define<std::string>("getProfile", [](Context&) { return std::string("default"); });
  list.define<std::string>("getLanguage", [](Context&) { return std::string("english"); });
  list.define<std::string, std::string>(
      "getDate", [](Context& c, const std::string& format) { return c.system.date(format); });
}

}  // namespace val3
