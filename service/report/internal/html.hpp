#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/report/words/words.hpp"

/// Elements of HTML, whose text is escaped, so that text from a robot, a file or an operator never becomes
/// markup. No template engine: one document has one layout, and a template would be a file to find at
/// run time.
namespace cell::html {

/// escaped_markup(), for what is put together here.
std::string escaped(std::string_view text);

/// <name attributes>inner</name>; `inner` is markup.
std::string element(std::string_view name, std::string_view inner, std::string_view attributes = {});

/// A text with the language that it is in, where that is not the document's.
struct Text {
  Text(std::string words, std::string_view tag = {}) : text(std::move(words)), language(tag) {}
  Text(const char* words) : text(words) {}

  std::string text;
  std::string_view language;  // empty: the document's
  std::string introduction;   // before the text, in the document's language
};

/// <name>text</name>, with the lang attribute where the text has a language of its own.
std::string text_element(std::string_view name, const Text& text);

/// A paragraph of text.
std::string paragraph(const Text& text);

/// A row of cells; each is text.
using Row = std::vector<Text>;

/// A table with caption and heading; without rows, a line that says so.
std::string table(const Words& words, std::string_view caption, const Row& heading,
                  const std::vector<Row>& rows);

}  // namespace cell::html
