#include "sim_controller/val3/files/elements.hpp"

#include <algorithm>
#include <charconv>

#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/folder_names.hpp"

namespace val3 {

std::vector<pugi::xml_node> Elements::children(pugi::xml_node parent, std::string_view name,
                                               std::initializer_list<std::string_view> others) {
  std::vector<pugi::xml_node> result;
  for (const pugi::xml_node node : parent.children()) {
    if (node.type() != pugi::node_element) continue;
    const std::string_view found = local_name(node.name());
    if (found == name)
      result.push_back(node);
    else if (std::ranges::find(others, found) == others.end())
      findings_.warning(file_rules::kUnknownElement, line_of(node),
                        shown_word(found) + " does not belong into " + shown_word(local_name(parent.name())),
                        "remove it");
  }
  return result;
}

pugi::xml_node Elements::child(pugi::xml_node parent, std::string_view name) {
  for (const pugi::xml_node node : parent.children())
    if (node.type() == pugi::node_element && local_name(node.name()) == name) return node;
  return {};
}

std::string Elements::required(pugi::xml_node node, std::string_view name) {
  const pugi::xml_attribute found = attribute_of(node, name);
  if (!found || *found.value() == '\0') {
    findings_.error(file_rules::kMissingAttribute, line_of(node),
                    shown_word(local_name(node.name())) + " has no " + std::string(name),
                    "write " + std::string(name) + "=\"...\"");
    return {};
  }
  return found.value();
}

std::string Elements::optional(pugi::xml_node node, std::string_view name, std::string_view otherwise) {
  const pugi::xml_attribute found = attribute_of(node, name);
  return found ? std::string(found.value()) : std::string(otherwise);
}

bool Elements::truth(pugi::xml_node node, std::string_view name, bool otherwise) {
  const pugi::xml_attribute found = attribute_of(node, name);
  if (!found) return otherwise;
  const std::string value = in_lower_case(found.value());
  if (value == "true" || value == "1") return true;
  if (value == "false" || value == "0") return false;
  findings_.error(file_rules::kBadValue, line_of(node),
                  std::string(name) + " is " + shown_word(found.value()), "write true or false");
  return otherwise;
}

void Elements::allow(pugi::xml_node node, std::initializer_list<std::string_view> names) {
  for (const pugi::xml_attribute attribute : node.attributes()) {
    const std::string_view name = attribute.name();
    if (name == "xmlns" || name.find(':') != std::string_view::npos) continue;
    if (std::ranges::find(names, name) == names.end())
      findings_.warning(file_rules::kUnknownAttribute, line_of(node),
                        shown_word(local_name(node.name())) + " has no attribute " + shown_word(name),
                        "remove it");
  }
}

std::optional<std::size_t> whole_number(std::string_view text, std::size_t most) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value > most) return std::nullopt;
  return value;
}

std::vector<std::size_t> sizes_in(std::string_view text) {
  constexpr std::size_t kDimensionMax = 100'000'000;
  std::vector<std::size_t> result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" ,"), text.size());
    if (end > 0) {
      const auto size = whole_number(text.substr(0, end), kDimensionMax);
      if (!size || result.size() == 3) return {};
      result.push_back(*size);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

}  // namespace val3
