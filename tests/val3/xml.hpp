#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tests/val3/problem.hpp"

namespace val3 {

/// An element of the XML that VAL3 projects are written in.
struct Element {
  std::string name;
  std::string space;  // namespace in force: that of the nearest xmlns, this element's own included
  int line = 0;
  std::map<std::string, std::string, std::less<>> attributes;  // with their prefix, as written
  std::vector<Element> children;
  std::string text;   // of this element alone
  int text_line = 0;  // of the first character of `text`

  /// The attribute's value, "" without one.
  [[nodiscard]] std::string attribute(std::string_view key) const;
  /// The first child of that name, or null.
  [[nodiscard]] const Element* child(std::string_view child_name) const;
};

/// The root element. Strict: an XML declaration, one root, every attribute once, only the five named
/// entities, the xsi prefix declared before it is used. A byte-order mark and CRLF are taken. Throws Problem.
Element read_xml(std::string_view bytes, const std::string& file);

}  // namespace val3
