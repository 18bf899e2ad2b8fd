#include "sim_controller/val3/files/old_data_file.hpp"

#include <algorithm>
#include <set>

#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/stored_attributes.hpp"

namespace val3 {
namespace {

constexpr std::string_view kSectionEnding = "Section";

/// "name[i]", "alias:name[i]"; empty for an empty name.
std::string father_of(pugi::xml_node node) {
  const std::string name = Elements::optional(node, "name");
  const std::string alias = Elements::optional(node, "alias");
  if (name.empty()) return {};
  return (alias.empty() ? "" : alias + ":") + name + '[' + Elements::optional(node, "fatherIndex", "0") + ']';
}

void copy_attributes(pugi::xml_node from, Attributes& to) {
  for (const pugi::xml_attribute attribute : from.attributes())
    to.emplace(attribute.name(), attribute.value());
}

/// The output that opens and closes a tool.
void copy_gripper(pugi::xml_node io, Attributes& to) {
  const std::string index = Elements::optional(io, "ioIndex", "0");
  const std::string name = Elements::optional(io, "name");
  if (!name.empty()) to["ioLink"] = index == "0" ? name : name + '[' + index + ']';
  to["ioOpen"] = Elements::optional(io, "open", "0");
  to["ioClose"] = Elements::optional(io, "close", "0");
}

class OldData {
 public:
  OldData(Elements& in, const DataContext& context) : in_(in), context_(context) {}

  void section(pugi::xml_node node, std::vector<Global>& globals) {
    const std::string_view name = local_name(node.name());
    const std::string_view word = name.substr(0, name.size() - kSectionEnding.size());
    const Kind kind = name.ends_with(kSectionEnding) ? kind_named(word) : Kind::kVoid;
    if (kind == Kind::kVoid)
      return in_.findings().error(file_rules::kUnknownElement, in_.line_of(node),
                                  shown_word(name) + " is no section of data", "remove it");
    for (const pugi::xml_node one : in_.children(node, word)) {
      Global global = entry(one, kind);
      if (!global.declared.name.empty() && !is_always_there(global)) globals.push_back(std::move(global));
    }
  }

 private:
  Global entry(pugi::xml_node node, Kind kind) {
    in_.allow(node, {"name", "public", "privilege", "size"});
    Global global;
    global.declared = {.name = in_.required(node, "name"),
                       .type = {kind, -1},
                       .file = in_.findings().file(),
                       .line = in_.line_of(node)};
    global.is_public = in_.truth(node, "public", false);
    std::string father;
    for (const pugi::xml_node part : node.children()) {
      if (part.type() != pugi::node_element) continue;
      const std::string_view name = local_name(part.name());
      if (name.ends_with("Father"))
        father = father_of(part);
      else if (name.starts_with("value"))
        global.values.push_back(value(part));
      else
        in_.findings().error(file_rules::kUnknownElement, in_.line_of(part),
                             shown_word(name) + " does not belong into a " + std::string(name_of(kind)),
                             "remove it");
    }
    if (father.empty() && kind == Kind::kFrame) father = "world[0]";
    if (father.empty() && kind == Kind::kTool) father = "flange[0]";
    finish(node, global, father);
    return global;
  }

  StoredValue value(pugi::xml_node node) {
    StoredValue result{.line = in_.line_of(node)};
    copy_attributes(node, result.attributes);
    for (const pugi::xml_node part : node.children()) {
      if (part.type() != pugi::node_element) continue;
      if (local_name(part.name()) == "io")
        copy_gripper(part, result.attributes);
      else
        copy_attributes(part, result.attributes);
    }
    return result;
  }

  /// The size is that of the values, whose order is free; the father is that of all of them.
  void finish(pugi::xml_node node, Global& global, const std::string& father) {
    std::size_t size = std::max<std::size_t>(global.values.size(), 1);
    if (attribute_of(node, "size")) {
      const std::string text = Elements::optional(node, "size");
      const auto given = sizes_in(text);
      if (given.size() == 1)
        size = std::max(size, given[0]);
      else
        in_.findings().error(file_rules::kBadSize, global.declared.line, "the size is " + shown_word(text),
                             "write a number of elements");
    }
    if (!context_.budget.take(size)) {
      in_.findings().error(file_rules::kBadSize, global.declared.line,
                           "the size " + std::to_string(size) + " is more than this reader takes");
      size = 1;
      global.values.clear();
    }
    global.declared.sizes = {size};
    std::set<std::size_t> seen;
    std::erase_if(global.values,
                  [&](StoredValue& value) { return !index_value(global, value, father, seen); });
  }

  bool index_value(const Global& global, StoredValue& value, const std::string& father,
                   std::set<std::size_t>& seen) {
    const auto given = value.attributes.find("index");
    const std::string text = given == value.attributes.end() ? "0" : given->second;
    const auto index = whole_number(text, global.declared.sizes[0] - 1);
    if (!index) {
      in_.findings().error(file_rules::kBadIndex, value.line,
                           shown_word(text) + " is no index of " + shown_word(global.declared.name) +
                               ", which has " + std::to_string(global.declared.sizes[0]) + " elements");
      return false;
    }
    if (!seen.insert(*index).second) {
      in_.findings().error(file_rules::kDuplicateIndex, value.line,
                           "the value of index " + text + " is there twice", "remove one of them");
      return false;
    }
    value.index = {*index};
    value.attributes.erase("index");
    if (!father.empty()) value.attributes.emplace("fatherId", father);
    value.attributes =
        checked_attributes(global.declared.type.kind, value.attributes, value.line, in_.findings());
    return true;
  }

  Elements& in_;
  const DataContext& context_;
};

}  // namespace

bool is_always_there(const Global& global) {
  return (global.declared.name == "world" && global.declared.type.kind == Kind::kFrame) ||
         (global.declared.name == "flange" && global.declared.type.kind == Kind::kTool);
}

void read_old_data(Elements& in, pugi::xml_node root, const DataContext& context,
                   std::vector<Global>& globals) {
  OldData data(in, context);
  for (const pugi::xml_node node : root.children())
    if (node.type() == pugi::node_element) data.section(node, globals);
}

}  // namespace val3
