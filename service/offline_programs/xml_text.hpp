#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace cell {

/// Larger than any VAL3 file has reason to be.
inline constexpr std::size_t kVal3FileBytesMax = 16U << 20U;

/// A VAL3 file as its bytes, and as elements and attributes that know where in these bytes they stand. The
/// bytes are never changed. UTF-8 with or without a byte order mark, or ISO-8859-1: in both every byte of
/// XML's own signs is that sign.
///
/// pugixml tells offsets of elements only (`offset_debug`); the file is parsed in place in a copy, where the
/// names and values that it hands out are addresses in that copy: their distance from its beginning is the
/// offset in the file, of attributes too.
class XmlText {
 public:
  /// `source`: what the bytes are called in errors. Throws ConfigError: larger than kVal3FileBytesMax, no
  /// text, another encoding, no XML of one outermost element.
  XmlText(std::string source, std::string bytes);
  XmlText(const XmlText&) = delete;
  XmlText& operator=(const XmlText&) = delete;

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
  /// The namespace of the root: "DataNameSpace", "http://www.staubli.com/robotics/VAL3/Data/2"; or empty.
  [[nodiscard]] std::string_view root_space() const;

  /// From 1.
  [[nodiscard]] int line_at(std::size_t place) const;
  [[nodiscard]] int line_of(pugi::xml_node element) const { return line_at(place_of(element.name())); }
  /// Offset in bytes() of a name or a value that an element, an attribute or a text handed out.
  [[nodiscard]] std::size_t place_of(const char* inside) const;

  /// The characters between an attribute's quotes as they stand in the file: [begin, end) in bytes().
  struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  [[nodiscard]] Span value_span(pugi::xml_attribute attribute) const;

  /// Throws ConfigError with the line of the element.
  [[noreturn]] void fail(pugi::xml_node element, const std::string& message) const;
  [[noreturn]] void fail_at_line(int line, const std::string& message) const;

 private:
  std::string source_;
  std::string bytes_;
  std::vector<char> parsed_;  // the copy that pugixml cuts up
  std::vector<std::size_t> line_starts_;
  pugi::xml_document document_;
};

/// The part of an element's or an attribute's name behind its prefix.
std::string_view unprefixed(const char* name);
/// The first element in `parent` of that name, prefixes aside; or an empty node.
pugi::xml_node element_named(pugi::xml_node parent, std::string_view name);
/// What xsi:type says, as opposed to type; or empty.
std::string_view xsi_type_of(pugi::xml_node element);

}  // namespace cell
