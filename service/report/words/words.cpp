#include "service/report/words/words.hpp"

#include <algorithm>

namespace cell {

Words::Words(std::string_view tag, char decimal_mark,
             std::initializer_list<std::span<const Translation>> tables)
    : tag_(tag), decimal_mark_(decimal_mark) {
  for (const std::span<const Translation> table : tables)
    for (const Translation& each : table) translated_.emplace(each.english, each.translated);
}

std::string_view Words::found(std::string_view english) const {
  const auto place = translated_.find(english);
  return place == translated_.end() ? english : place->second;
}

std::string Words::figure(const std::optional<double>& value, std::string_view format) const {
  return value ? (*this)(format, *value) : (*this)("unknown");
}

std::string Words::if_known(const std::optional<double>& value, std::string_view format) const {
  return value ? (*this)(format, *value) : std::string();
}

std::string Words::or_dash(const std::optional<double>& value, std::string_view format) const {
  return value ? (*this)(format, *value) : "–";
}

std::string Words::known(const std::optional<std::string>& text) const {
  return text && !text->empty() ? *text : (*this)("unknown");
}

std::string Words::number(std::string text) const {
  std::ranges::replace(text, '.', decimal_mark_);
  return text;
}

std::string Words::numbers(std::span<const std::string> texts) const {
  return number(fmt::format("{}", fmt::join(texts, decimal_mark_ == ',' ? "; " : ", ")));
}

const Words& english() {
  static const Words kEnglish("en", '.', {});
  return kEnglish;
}

const Words* words_in(std::string_view tag) {
  static const Words kFrench("fr", ',', {kWordsFr, kVerificationWordsFr});
  static const Words kGerman("de", ',', {kWordsDe, kVerificationWordsDe});
  for (const Words* words : {&english(), &kFrench, &kGerman})
    if (words->tag() == tag) return words;
  return nullptr;
}

}  // namespace cell
