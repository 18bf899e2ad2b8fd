// Data files of s5 and s6: one section a type, the numbers in an element within the value, the father once
// for the whole variable.
#include <algorithm>
#include <set>
#include <utility>

#include "config/config_error.hpp"
#include "service/offline_programs/stored_data.hpp"

namespace cell {
namespace {

constexpr std::string_view kSection = "Section";

constexpr std::pair<std::string_view, StoredKind> kOldTypes[] = {
    {"aio", StoredKind::kPlain},        {"bool", StoredKind::kPlain},       {"configRs", StoredKind::kPlain},
    {"config", StoredKind::kPlain},     {"configVrb", StoredKind::kPlain},  {"dio", StoredKind::kPlain},
    {"frame", StoredKind::kFrame},      {"jointRs", StoredKind::kOtherArm}, {"joint", StoredKind::kJoint},
    {"jointVrb", StoredKind::kJoint},   {"mdesc", StoredKind::kPlain},      {"num", StoredKind::kPlain},
    {"pointRs", StoredKind::kOtherArm}, {"point", StoredKind::kPoint},      {"pointVrb", StoredKind::kPoint},
    {"sio", StoredKind::kPlain},        {"string", StoredKind::kPlain},     {"tool", StoredKind::kPlain},
    {"trsf", StoredKind::kTrsf}};

class OldDataReader {
 public:
  explicit OldDataReader(VariableReader& reader) : reader_(reader), xml_(reader.xml) {}

  void run() {
    for (const pugi::xml_node section : xml_.root().children()) {
      if (section.type() != pugi::node_element) continue;
      const std::string_view name = unprefixed(section.name());
      const std::string_view type =
          name.ends_with(kSection) ? name.substr(0, name.size() - kSection.size()) : std::string_view{};
      const auto* const known =
          std::ranges::find(kOldTypes, type, &std::pair<std::string_view, StoredKind>::first);
      if (known == std::end(kOldTypes))
        xml_.fail(section,
                  in_quotes(std::string(name)) + " is no section of data; remove it, or save the file as s7");
      for (const pugi::xml_node one : section.children())
        if (one.type() == pugi::node_element && unprefixed(one.name()) == type) variable(one, *known);
    }
  }

 private:
  void variable(pugi::xml_node node, const std::pair<std::string_view, StoredKind>& type) {
    StoredVariable result{.name = reader_.required(node, "name"),
                          .kind = type.second,
                          .type = std::string(type.first),
                          .line = xml_.line_of(node)};
    const bool is_read = result.kind == StoredKind::kPoint || result.kind == StoredKind::kJoint ||
                         result.kind == StoredKind::kFrame || result.kind == StoredKind::kTrsf;
    if (is_read) elements(node, result);
    reader_.keep(node, std::move(result));
  }

  void elements(pugi::xml_node node, StoredVariable& variable) {
    std::optional<FrameName> father;
    std::set<std::string> keys;
    for (const pugi::xml_node part : node.children()) {
      if (part.type() != pugi::node_element) continue;
      const std::string_view name = unprefixed(part.name());
      if (name.ends_with("Father")) {
        father = father_of(part);
      } else if (name.starts_with("value")) {
        StoredElement one = element(part, variable.kind);
        if (!keys.insert(one.key).second)
          xml_.fail(part, shown_element(variable, one.key) + " is there twice; remove one of them");
        variable.elements.push_back(std::move(one));
      } else {
        xml_.fail(part,
                  in_quotes(std::string(name)) + " does not belong into a " + variable.type + "; remove it");
      }
    }
    variable.size = std::max<std::size_t>(variable.elements.size(), 1);
    for (StoredElement& one : variable.elements) one.father = father;
  }

  [[nodiscard]] std::optional<FrameName> father_of(pugi::xml_node node) const {
    FrameName father{.alias = node.attribute("alias").value(), .name = node.attribute("name").value()};
    if (father.name.empty()) return std::nullopt;
    father.key = reader_.index_key(node, node.attribute("fatherIndex").as_string("0"));
    return father;
  }

  StoredElement element(pugi::xml_node value, StoredKind kind) {
    reader_.take_element(value);
    StoredElement result{.line = xml_.line_of(value)};
    result.key = reader_.index_key(value, value.attribute("index").as_string("0"));
    for (const pugi::xml_node part : value.children()) {
      if (part.type() != pugi::node_element) continue;
      if (unprefixed(part.name()).starts_with("cp")) {
        result.posture = reader_.posture_of(part);
      } else if (!result.numbers) {
        result.numbers = number_places(xml_, part, kind == StoredKind::kJoint ? kJointNames : kTrsfNames);
      }
    }
    return result;
  }

  VariableReader& reader_;
  const XmlText& xml_;
};

}  // namespace

void read_old_stored_data(VariableReader& reader) { OldDataReader(reader).run(); }

}  // namespace cell
