#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Pieces of HTML. Text becomes markup here and nowhere else: what comes from a robot, a file or an operator
/// stays text. No template engine: one document has one layout, and a template would be a file to find at run
/// time.
namespace cell::html {

/// The text with the five characters that mean something in HTML written as references; bytes that are no
/// character of a page (controls) are left out.
std::string escaped(std::string_view text);

/// <name attributes>inner</name>; `inner` is markup.
std::string element(std::string_view name, std::string_view inner, std::string_view attributes = {});

/// A paragraph of text.
std::string paragraph(std::string_view text);

/// A row of cells; each is text.
using Row = std::vector<std::string>;

/// A table with a caption and a heading; no rows: a line that says so.
std::string table(std::string_view caption, const Row& heading, const std::vector<Row>& rows);

}  // namespace cell::html
