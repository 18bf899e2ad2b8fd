#include "sim_controller/val3/files/data_file.hpp"

#include <algorithm>
#include <set>

#include "sim_controller/val3/files/elements.hpp"
#include "sim_controller/val3/files/file_rules.hpp"
#include "sim_controller/val3/files/old_data_file.hpp"
#include "sim_controller/val3/files/stored_attributes.hpp"

namespace val3 {
namespace {

constexpr int kFieldsDeepMax = 16;

/// Reads Data and Field elements: they differ by their name and access only.
class StoredData {
 public:
  StoredData(Elements& in, const DataContext& context) : in_(in), context_(context) {}

  /// False when it has no name or no type.
  bool declaration(pugi::xml_node node, Declaration& declared) {
    declared.name = in_.required(node, "name");
    declared.file = in_.findings().file();
    declared.line = in_.line_of(node);
    const std::string word = in_.required(node, "type");
    declared.type = context_.words.find(word);
    if (declared.type.kind == Kind::kVoid && !word.empty())
      in_.findings().error(file_rules::kUnknownType, declared.line, shown_word(word) + " is no type",
                           "list it under Types");
    const std::string_view form = schema_type_of(node);
    if (form == "collection")
      declared.sizes.clear();
    else
      sizes(node, declared);
    if (!form.empty() && form != "collection" && form != "array" && form != "element")
      in_.findings().error(file_rules::kBadValue, declared.line, "xsi:type is " + shown_word(form),
                           "write array or collection");
    return !declared.name.empty() && declared.type.kind != Kind::kVoid;
  }

  std::vector<StoredValue> values(pugi::xml_node node, const Declaration& declared, int depth) {
    std::vector<StoredValue> result;
    std::set<std::string, std::less<>> seen;
    for (const pugi::xml_node value : in_.children(node, "Value")) {
      StoredValue stored{.line = in_.line_of(value)};
      if (!key(value, declared, stored)) continue;
      if (!seen.insert(stored.key.empty() ? key_of(stored.index) : stored.key).second) {
        in_.findings().error(
            file_rules::kDuplicateIndex, stored.line,
            "the value of " + shown_word(attribute_of(value, "key").value()) + " is there twice",
            "remove one of them");
        continue;
      }
      content(value, declared, stored, depth);
      result.push_back(std::move(stored));
    }
    return result;
  }

 private:
  static std::string key_of(const std::vector<std::size_t>& index) {
    std::string result;
    for (const std::size_t i : index) result += std::to_string(i) + ' ';
    return result;
  }

  void sizes(pugi::xml_node node, Declaration& declared) {
    const std::string text = Elements::optional(node, "size", "1");
    std::vector<std::size_t> found = sizes_in(text);
    const std::size_t elements =
        ElementBudget::of(found, ElementBudget::of(declared.type, context_.elements_of_user));
    if (found.empty()) {
      in_.findings().error(file_rules::kBadSize, declared.line, "the size is " + shown_word(text),
                           "write one to three numbers of elements");
    } else if (!context_.budget.take(elements)) {
      in_.findings().error(file_rules::kBadSize, declared.line,
                           "the size " + shown_word(text) + " is more than this reader takes: " +
                               std::to_string(kElementsMax) + " elements together");
    } else {
      declared.sizes = std::move(found);
    }
  }

  /// The index, or the key of a collection. False when it is none.
  bool key(pugi::xml_node node, const Declaration& declared, StoredValue& stored) {
    const std::string text = Elements::optional(node, "key", declared.is_collection() ? "" : "0");
    if (declared.is_collection()) {
      stored.key = text;
      if (text.empty())
        in_.findings().error(file_rules::kBadIndex, stored.line, "a value of a collection has no key");
      return !text.empty();
    }
    stored.index = sizes_in(text);
    // How s7 numbers the elements of more dimensions is not attested: both writings are taken.
    if (stored.index.size() == 1 && declared.sizes.size() > 1)
      stored.index = spread(stored.index[0], declared.sizes);
    bool inside = stored.index.size() == declared.sizes.size();
    for (std::size_t i = 0; inside && i < stored.index.size(); ++i)
      inside = stored.index[i] < declared.sizes[i];
    if (!inside)
      in_.findings().error(file_rules::kBadIndex, stored.line,
                           shown_word(text) + " is no index of " + shown_word(declared.name),
                           "an array counts from 0");
    return inside;
  }

  static std::vector<std::size_t> spread(std::size_t flat, const std::vector<std::size_t>& sizes) {
    std::vector<std::size_t> result(sizes.size());
    for (std::size_t i = sizes.size(); i-- > 1;) {
      result[i] = sizes[i] == 0 ? flat : flat % sizes[i];
      flat = sizes[i] == 0 ? flat : flat / sizes[i];
    }
    result[0] = flat;
    return result;
  }

  void content(pugi::xml_node node, const Declaration& declared, StoredValue& stored, int depth) {
    if (declared.type.kind == Kind::kUser) return fields(node, declared, stored, depth);
    in_.children(node, "");
    Attributes attributes;
    for (const pugi::xml_attribute attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (name != "key" && name != "xmlns" && name.find(':') == std::string_view::npos)
        attributes.emplace(name, attribute.value());
    }
    stored.attributes = checked_attributes(declared.type.kind, attributes, stored.line, in_.findings());
  }

  void fields(pugi::xml_node node, const Declaration& declared, StoredValue& stored, int depth) {
    if (depth >= kFieldsDeepMax)
      return in_.findings().error(
          file_rules::kNestedTooDeep, stored.line,
          "fields are nested deeper than " + std::to_string(kFieldsDeepMax) + " times");
    in_.allow(node, {"key"});
    const UserType& type = context_.user_types[static_cast<std::size_t>(declared.type.user)];
    std::set<std::string, std::less<>> seen;
    for (const pugi::xml_node one : in_.children(node, "Field")) {
      StoredField field;
      in_.allow(one, {"name", "type", "size"});
      field.declared.name = in_.required(one, "name");
      const auto known = std::ranges::find(type.fields, field.declared.name,
                                           [](const Global& of_type) { return of_type.declared.name; });
      if (known == type.fields.end()) {
        if (!type.project.empty())  // else its project was not found, which is told
          in_.findings().error(
              file_rules::kUnknownElement, in_.line_of(one),
              "the type " + type.name + " has no public field " + shown_word(field.declared.name),
              "remove it, or make it public there");
        continue;
      }
      if (!seen.insert(field.declared.name).second) {
        in_.findings().error(file_rules::kDuplicateName, in_.line_of(one),
                             "the field " + shown_word(field.declared.name) + " is there twice");
        continue;
      }
      field_of_type(one, known->declared, field);
      field.values = values(one, field.declared, depth + 1);
      stored.fields.push_back(std::move(field));
    }
  }

  /// A field is of the type that the user type says; the file may give its array another size.
  void field_of_type(pugi::xml_node node, const Declaration& of_type, StoredField& field) {
    field.declared.type = of_type.type;
    field.declared.file = in_.findings().file();
    field.declared.line = in_.line_of(node);
    field.declared.sizes = of_type.sizes;
    const std::string word = Elements::optional(node, "type");
    const Kind kind = kind_named(word);
    if (kind != Kind::kVoid && of_type.type.kind != Kind::kUser && kind != of_type.type.kind)
      in_.findings().error(file_rules::kUnknownType, field.declared.line,
                           "the field " + field.declared.name + " is a " +
                               std::string(name_of(of_type.type.kind)) + ", not a " +
                               std::string(name_of(kind)));
    if (!of_type.is_collection() && attribute_of(node, "size")) sizes(node, field.declared);
  }

  Elements& in_;
  const DataContext& context_;
};

void read_new_data(Elements& in, pugi::xml_node root, const DataContext& context,
                   std::vector<Global>& globals) {
  StoredData data(in, context);
  in.children(root, "Datas");
  for (const pugi::xml_node node : in.children(Elements::child(root, "Datas"), "Data")) {
    in.allow(node, {"name", "access", "type", "size"});
    Global global;
    const std::string access = Elements::optional(node, "access", "private");
    if (access != "public" && access != "private")
      in.findings().error(file_rules::kBadValue, in.line_of(node), "access is " + shown_word(access),
                          "write public or private");
    global.is_public = access == "public";
    if (!data.declaration(node, global.declared)) continue;
    global.values = data.values(node, global.declared, 0);
    if (!is_always_there(global)) globals.push_back(std::move(global));
  }
}

}  // namespace

void read_data_file(const XmlFile& xml, const DataContext& context, FileFindings& findings,
                    std::vector<Global>& globals) {
  Elements in(xml, findings);
  if (xml.root_name() == "Database" &&
      xml.root_space().starts_with("http://www.staubli.com/robotics/VAL3/Data/"))
    return read_new_data(in, xml.root(), context, globals);
  if (xml.root_name() == "dataList" && xml.root_space() == "DataNameSpace")
    return read_old_data(in, xml.root(), context, globals);
  findings.error(
      file_rules::kUnknownForm, xml.line_of(xml.root()),
      shown_word(xml.root_name()) + " of " + shown_word(xml.root_space()) + " is no VAL3 data of s5 to s8");
}

}  // namespace val3
