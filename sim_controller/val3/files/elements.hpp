#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "sim_controller/val3/files/xml_file.hpp"

namespace val3 {

/// The elements and attributes of one file, as its readers ask for them: what is missing, unknown or of the
/// wrong form is found once, here. What is unknown is a warning: a later version may know it.
class Elements {
 public:
  Elements(const XmlFile& xml, FileFindings& findings) : xml_(xml), findings_(findings) {}

  /// Children of that name; others are found unless they are in `others`.
  std::vector<pugi::xml_node> children(pugi::xml_node parent, std::string_view name,
                                       std::initializer_list<std::string_view> others = {});
  /// The first child of that name, or an empty node.
  static pugi::xml_node child(pugi::xml_node parent, std::string_view name);
  /// Text or CDATA straight in the element, in one.
  [[nodiscard]] XmlFile::Text text_of(pugi::xml_node node) const { return xml_.text_of(node); }

  /// Found when it is missing; then empty.
  std::string required(pugi::xml_node node, std::string_view name);
  static std::string optional(pugi::xml_node node, std::string_view name, std::string_view otherwise = {});
  /// true or false; `otherwise` when it is missing, or is neither, which is found.
  bool truth(pugi::xml_node node, std::string_view name, bool otherwise);
  /// Attributes that are not in the list are found. xmlns and those with a prefix are not looked at.
  void allow(pugi::xml_node node, std::initializer_list<std::string_view> names);

  [[nodiscard]] int line_of(pugi::xml_node node) const { return xml_.line_of(node); }
  FileFindings& findings() { return findings_; }

 private:
  const XmlFile& xml_;
  FileFindings& findings_;
};

/// A whole number of digits, of at most `most`.
std::optional<std::size_t> whole_number(std::string_view text, std::size_t most);
/// "3", "3 2", "3 2 4": one to three sizes of an array; empty when it is none of these.
std::vector<std::size_t> sizes_in(std::string_view text);

}  // namespace val3
