#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Elements of HTML. The only place that escapes text, so that text from a robot, a file or an operator never
/// becomes markup. No template engine: one document has one layout, and a template would be a file to find at
/// run time.
namespace cell::html {

/// The text with the five special characters of HTML as references; control characters are left out.
std::string escaped(std::string_view text);

/// <name attributes>inner</name>; `inner` is markup.
std::string element(std::string_view name, std::string_view inner, std::string_view attributes = {});

/// A paragraph of text.
std::string paragraph(std::string_view text);

/// A row of cells; each is text.
using Row = std::vector<std::string>;

/// A table with caption and heading; without rows, a line that says so.
std::string table(std::string_view caption, const Row& heading, const std::vector<Row>& rows);

}  // namespace cell::html
