#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sim_controller/val3/files/file_findings.hpp"

namespace val3 {

/// The bytes of a regular file of at most `bytes_max`, or why there are none.
std::optional<std::string> read_bounded(const std::filesystem::path& path, std::size_t bytes_max,
                                        FileFindings& findings);

/// One XML file in memory, with the lines of its elements. Text is UTF-8 whatever the file has: UTF-8 with or
/// without a byte order mark, or ISO-8859-1 where it declares that.
class XmlFile {
 public:
  /// Null when the bytes are no XML document of one element, which is found.
  static std::unique_ptr<XmlFile> parse(std::string bytes, FileFindings& findings);

  [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
  /// The name of the root, without a prefix.
  [[nodiscard]] std::string_view root_name() const;
  /// The namespace of the root: "DataNameSpace", "http://www.staubli.com/robotics/VAL3/Data/2"; or empty.
  [[nodiscard]] std::string_view root_space() const;
  /// From 1; 0 when the node is none of the file.
  [[nodiscard]] int line_of(pugi::xml_node node) const;

  struct Text {
    std::string text;
    int line = 0;  // of its first character
  };
  /// An element's text and CDATA, in one. A gap of lines between parts is kept.
  [[nodiscard]] Text text_of(pugi::xml_node element) const;

 private:
  XmlFile() = default;
  [[nodiscard]] int line_at(std::ptrdiff_t offset) const;

  std::string utf8_;
  std::vector<std::size_t> line_starts_;
  pugi::xml_document document_;
};

/// The part of an element's or an attribute's name behind its prefix.
std::string_view local_name(const char* name);
/// The attribute of that very name; empty when there is none.
pugi::xml_attribute attribute_of(pugi::xml_node node, std::string_view name);
/// xsi:type, as opposed to type.
std::string_view schema_type_of(pugi::xml_node node);

}  // namespace val3
