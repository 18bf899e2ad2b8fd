// The user page, keys and the log (manual 6, pages 67 to 74).
#include <array>
#include <cstdio>

#include "sim_controller/val3/machine/builtins.hpp"

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

Nothing show(Context& context, bool fixed) {
  context.system.show_page(fixed);
  return {};
}

}  // namespace

void define_page(Builtins& list) {
  list.define<Nothing>("userPage", [](Context& c) { return show(c, false); });
  list.define<Nothing, bool>("userPage", show);
  list.define<Nothing, std::string>("userPage",
                                    [](Context& c, const std::string&) { return show(c, false); });
  list.define<Nothing, Screen>("userPage", [](Context& c, const Screen&) { return show(c, false); });
  list.define<Nothing>("cls", [](Context& c) {
    c.system.clear_page();
    return Nothing{};
  });
  list.define<Nothing, double, double>("gotoxy", [](Context& c, double column, double row) {
    constexpr double kMax = 1e6;
    c.system.go_to(static_cast<int>(std::min(std::max(column, 0.0), kMax)),
                   static_cast<int>(std::min(std::max(row, 0.0), kMax)));
    return Nothing{};
  });
  list.define<Nothing, std::string>("put", put_text<false>);
  list.define<Nothing, double>("put", put_number<false>);
  list.define<Nothing, std::string>("putln", put_text<true>);
  list.define<Nothing, double>("putln", put_number<true>);
  list.define<Nothing, std::string>("title", [](Context& c, const std::string& text) {
    c.system.title(text);
    return Nothing{};
  });
  list.define<double, std::string>(
      "getDisplayLen", [](Context&, const std::string& text) { return static_cast<double>(text.size()); });
  list.define<double>("getKey", key);
  list.define<double>("get", awaited_key);
  list.define<bool, double>("isKeyPressed", [](Context& c, double code) {
    return code >= 0.0 && code <= 1e6 && c.system.key_is_pressed(static_cast<int>(code));
  });
  list.define<Nothing, std::string>("popUpMsg", [](Context& c, const std::string& text) {
    c.system.pop_up(text);
    return Nothing{};
  });
  list.define<Nothing, std::string>("logMsg", [](Context& c, const std::string& text) {
    c.system.log(text);
    return Nothing{};
  });
  list.define<Nothing, std::string, double>("logMsg", [](Context& c, const std::string& text, double) {
    c.system.log(text);
    return Nothing{};
  });
  list.define<std::string>("getProfile", [](Context&) { return std::string("default"); });
  list.define<std::string>("getLanguage", [](Context&) { return std::string("english"); });
  list.define<std::string, std::string>(
      "getDate", [](Context& c, const std::string& format) { return c.system.date(format); });
}

}  // namespace val3
