#include "service/offline_programs/number_places.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "config/config_error.hpp"

namespace cell {
namespace {

/// A finite number that fills the text.
std::optional<double> whole_text_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

NumberPlace written_number(const XmlText& xml, pugi::xml_node element, pugi::xml_attribute attribute) {
  auto [begin, end] = xml.value_span(attribute);
  const std::string& bytes = xml.bytes();
  while (begin < end && bytes[begin] == ' ') ++begin;
  while (begin < end && bytes[end - 1] == ' ') --end;
  const std::string text = bytes.substr(begin, end - begin);
  const auto value = whole_text_number(text);
  if (!value)
    xml.fail(element, std::string(attribute.name()) + " is " + in_quotes(text) + "; write a number");
  if (std::abs(*value) > kStoredNumberMax)
    xml.fail(element, std::string(attribute.name()) + " is " + text + "; no place of an arm's is beyond " +
                          stored_number(kStoredNumberMax));
  return {*value, true, begin, end};
}

/// Behind the closing quote.
std::size_t end_of(const XmlText& xml, pugi::xml_attribute attribute) {
  return xml.value_span(attribute).end + 1;
}

char quote_in(const XmlText& xml, std::size_t place) {
  // What stands before a place behind an attribute is that attribute's quote; behind a name the usual one.
  const char before = xml.bytes()[place - 1];
  return before == '\'' ? '\'' : '"';
}

}  // namespace

NumberPlaces number_places(const XmlText& xml, pugi::xml_node element, const SixNames& names) {
  std::array<pugi::xml_attribute, 6> found;
  const std::string_view name = element.name();
  std::size_t behind = xml.place_of(element.name()) + name.size();
  for (const pugi::xml_attribute attribute : element.attributes()) {
    const std::string_view word = attribute.name();
    if (word == "key" || word == "index") behind = end_of(xml, attribute);
    const auto at = std::ranges::find(names, word);
    if (at == names.end()) continue;
    auto& place = found[static_cast<std::size_t>(at - names.begin())];
    if (place) xml.fail(element, std::string(word) + " is there twice; remove one of them");
    place = attribute;
  }
  NumberPlaces places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (found[i]) {
      places[i] = written_number(xml, element, found[i]);
      behind = end_of(xml, found[i]);
    } else {
      places[i] = {.begin = behind, .end = behind};
    }
  }
  return places;
}

SixNumbers numbers_of(const NumberPlaces& places) {
  SixNumbers numbers{};
  for (std::size_t i = 0; i < places.size(); ++i) numbers[i] = places[i].value;
  return numbers;
}

std::string stored_number(double value, int decimals) {
  if (!std::isfinite(value)) throw std::logic_error("a number that is not finite is to be stored");
  std::string text = fmt::format("{:.{}f}", value, decimals);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string edited(std::string_view text, std::vector<TextEdit> edits) {
  std::ranges::stable_sort(edits, {}, &TextEdit::begin);
  std::string result;
  result.reserve(text.size() + 16 * edits.size());
  std::size_t done = 0;
  for (const TextEdit& edit : edits) {
    if (edit.begin < done || edit.end < edit.begin || edit.end > text.size())
      throw std::logic_error("edits of a text overlap, or lie outside of it");
    result.append(text, done, edit.begin - done).append(edit.text);
    done = edit.end;
  }
  return result.append(text, done);
}

std::vector<std::string> append_edits(const XmlText& xml, const NumberPlaces& places, const SixNames& names,
                                      const SixNumbers& numbers, std::vector<TextEdit>& edits) {
  std::vector<std::string> inserted;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const NumberPlace& place = places[i];
    std::string text = stored_number(numbers[i]);
    if (text == stored_number(place.value)) continue;
    if (!place.is_written) {
      const char quote = quote_in(xml, place.begin);
      text = fmt::format(" {}={}{}{}", names[i], quote, text, quote);
      inserted.emplace_back(names[i]);
    }
    edits.push_back({place.begin, place.end, std::move(text)});
  }
  return inserted;
}

}  // namespace cell
