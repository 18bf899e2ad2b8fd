#pragma once

#include <spdlog/fmt/fmt.h>

#include <concepts>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// The language of a report. The English text is the key, as gettext has it, so that the parts of a report
/// stay readable; placeholders are those of fmt, with numbers where a language needs another order.
namespace cell {

struct Translation {
  std::string_view english;
  std::string_view translated;
};

/// A figure in a language's form: what fmt makes of a double, with the language's decimal mark.
struct LocalFigure {
  double value = 0.0;
  char decimal_mark = '.';
};

class Words {
 public:
  /// `tag` as HTML's lang attribute has it; `tables` without a text twice. English has no table.
  Words(std::string_view tag, char decimal_mark, std::initializer_list<std::span<const Translation>> tables);

  [[nodiscard]] std::string_view tag() const { return tag_; }
  [[nodiscard]] bool has(std::string_view english) const { return translated_.contains(english); }

  /// The text in this language; the English one where the table does not have it.
  std::string operator()(std::string_view english) const { return std::string(found(english)); }

  /// The same with its placeholders filled; each double gets the language's decimal mark.
  template <class... Values>
    requires(sizeof...(Values) > 0)
  std::string operator()(std::string_view english, const Values&... values) const {
    return fmt::vformat(found(english), fmt::make_format_args(localized(values)...));
  }

  /// A value in the text `format`, which may have words; "unknown" if there is none.
  [[nodiscard]] std::string figure(const std::optional<double>& value, std::string_view format) const;
  /// The same, but empty or a dash where there is none.
  [[nodiscard]] std::string if_known(const std::optional<double>& value, std::string_view format) const;
  [[nodiscard]] std::string or_dash(const std::optional<double>& value, std::string_view format) const;

  /// A name or another text that is in no language; "unknown" if it is empty or absent.
  [[nodiscard]] std::string known(const std::optional<std::string>& text) const;

  /// Numbers that are text already with the language's decimal mark.
  [[nodiscard]] std::string number(std::string text) const;
  /// A list of them; with a decimal comma semicolons separate.
  [[nodiscard]] std::string numbers(std::span<const std::string> texts) const;

 private:
  [[nodiscard]] std::string_view found(std::string_view english) const;

  template <class Value>
  [[nodiscard]] decltype(auto) localized(const Value& value) const {
    if constexpr (std::floating_point<Value>) {
      return LocalFigure{value, decimal_mark_};
    } else {
      return (value);
    }
  }

  std::string_view tag_;
  char decimal_mark_;
  std::map<std::string_view, std::string_view> translated_;
};

extern const std::span<const Translation> kWordsFr, kVerificationWordsFr;
extern const std::span<const Translation> kWordsDe, kVerificationWordsDe;

const Words& english();

/// Of "en", "fr" or "de"; null for another language.
const Words* words_in(std::string_view tag);

}  // namespace cell

template <>
struct fmt::formatter<cell::LocalFigure> : fmt::formatter<double> {
  fmt::format_context::iterator format(const cell::LocalFigure& figure, fmt::format_context& context) const {
    fmt::memory_buffer text;
    fmt::format_context inner(fmt::appender(text), context.args(), context.locale());
    fmt::formatter<double>::format(figure.value, inner);
    auto out = context.out();
    for (const char c : text) *out++ = c == '.' ? figure.decimal_mark : c;
    return out;
  }
};
