// What every page and section is made of.
#include <spdlog/fmt/fmt.h>

#include "service/report/internal/html.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

constexpr std::string_view kStyle = R"(
@page { size: A4; margin: 18mm 14mm 14mm; }
body { font: 10pt/1.4 sans-serif; color: #000; background: #fff; max-width: 190mm; margin: 0 auto; padding: 0 4mm; }
h1 { font-size: 16pt; } h2 { font-size: 12pt; border-bottom: 1px solid #000; break-after: avoid; margin-top: 8mm; }
table { border-collapse: collapse; width: 100%; margin: 4mm 0; break-inside: auto; font-size: 8.5pt; }
caption { text-align: left; font-weight: bold; padding: 1mm 0; break-after: avoid; }
th, td { border-bottom: 1px solid #bbb; padding: 0.6mm 1.6mm; text-align: left; }
td:last-child { overflow-wrap: anywhere; }
thead { display: table-header-group; } tr { break-inside: avoid; }
.short { break-inside: avoid; }
svg { width: 49%; height: auto; font: 9px sans-serif; break-inside: avoid; }
.verdict { border: 2px solid #000; padding: 3mm 4mm; margin: 4mm 0; }
.verdict strong { font-size: 20pt; }
.front { break-after: page; }
.front h1, .front .verdict, .front .verdict p { margin: 1.5mm 0; } .front .verdict { padding: 1mm 4mm; }
.front table { font-size: 7.5pt; line-height: 1.15; margin: 2mm 0; } .front th, .front td { padding: 0.1mm 1.6mm; }
.front > p { font-size: 8pt; margin: 1mm 0; }
.sign { display: flex; gap: 8mm; margin: 3mm 0; break-inside: avoid; }
.sign div { flex: 1; border: 1px solid #000; padding: 2mm 3mm; }
.sign p { border-bottom: 1px solid #bbb; margin: 0; padding-top: 5mm; }
)";

/// The head of each printed page.
std::string page_head(const Words& words, std::string_view title) {
  return fmt::format(
      R"(@page {{ @top-left {{ content: "{}"; font: 8pt sans-serif; }}
@top-right {{ content: counter(page) " {} " counter(pages); font: 8pt sans-serif; }} }}
)",
      title, words("of"));
}

}  // namespace

html::Text in_english(const Words& words, std::string_view introduction, const std::string& text) {
  const bool is_english = words.tag() == english().tag();
  html::Text told(text, is_english ? std::string_view() : english().tag());
  (is_english ? told.text : told.introduction) = words(introduction) + (is_english ? text : "");
  return told;
}

html::Text stored_text(const Words& words, const std::string& text) {
  if (text.empty()) return words("unknown");
  if (words.has(text)) return words(text);
  return {text, words.tag() == english().tag() ? std::string_view() : english().tag()};
}

std::vector<html::Text> stored_texts(const Words& words, const std::vector<std::string>& texts) {
  std::vector<html::Text> told;
  for (const std::string& text : texts) told.push_back(stored_text(words, text));
  return told;
}

std::string section(std::string_view title, const std::string& inner) {
  return html::element("section", html::element("h2", html::escaped(title)) + "\n" + inner) + "\n";
}

std::string pairs_table(const Words& words, std::string_view caption, const std::vector<html::Row>& rows) {
  return html::table(words, caption, {words("what"), words("value")}, rows);
}

std::string bullets(const std::vector<html::Text>& texts) {
  std::string items;
  for (const html::Text& text : texts) items += html::text_element("li", text);
  return items.empty() ? items : html::element("ul", items) + "\n";
}

std::string printed_page(const Words& words, std::string_view title, const std::string& body) {
  return "<!DOCTYPE html>\n" +
         html::element(
             "html",
             html::element("head",
                           R"(<meta charset="utf-8">)" + html::element("title", html::escaped(title)) +
                               html::element("style", std::string(kStyle) + page_head(words, title))) +
                 "\n" + html::element("body", "\n" + body),
             fmt::format(R"(lang="{}")", words.tag())) +
         "\n";
}

}  // namespace cell
