#include "service/report/internal/html.hpp"

#include <spdlog/fmt/fmt.h>

#include "service/base/escaped_markup.hpp"

namespace cell::html {
namespace {

std::string row_of(const Row& cells, std::string_view name) {
  std::string inner;
  for (const Text& cell : cells) inner += text_element(name, cell);
  return element("tr", inner) + "\n";
}

}  // namespace

std::string escaped(std::string_view text) { return escaped_markup(text); }

std::string element(std::string_view name, std::string_view inner, std::string_view attributes) {
  return fmt::format("<{0}{1}{2}>{3}</{0}>", name, attributes.empty() ? "" : " ", attributes, inner);
}

std::string text_element(std::string_view name, const Text& text) {
  if (!text.introduction.empty())
    return element(name, escaped(text.introduction) + text_element("span", {text.text, text.language}));
  return element(name, escaped(text.text),
                 text.language.empty() ? std::string() : fmt::format(R"(lang="{}")", text.language));
}

std::string paragraph(const Text& text) { return text_element("p", text) + "\n"; }

std::string table(const Words& words, std::string_view caption, const Row& heading,
                  const std::vector<Row>& rows) {
  if (rows.empty()) return paragraph(words("{}: there are none.", caption));
  std::string body;
  for (const Row& row : rows) body += row_of(row, "td");
  constexpr std::size_t kShortRows = 12;  // such a table stays on one page
  return element("table",
                 element("caption", escaped(caption)) + element("thead", row_of(heading, "th")) +
                     element("tbody", body),
                 rows.size() <= kShortRows ? R"(class="short")" : "") +
         "\n";
}

}  // namespace cell::html
