#include "service/offline_programs/stored_data.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "config/config_error.hpp"

namespace cell {
namespace {

constexpr std::size_t kDimensionsMax = 3;
constexpr std::size_t kDimensionMax = 100'000'000;
constexpr std::string_view kNewDataSpace = "http://www.staubli.com/robotics/VAL3/Data/";

constexpr std::pair<std::string_view, StoredKind> kNewTypes[] = {
    {"pointRx", StoredKind::kPoint}, {"point", StoredKind::kPoint},      {"jointRx", StoredKind::kJoint},
    {"joint", StoredKind::kJoint},   {"frame", StoredKind::kFrame},      {"trsf", StoredKind::kTrsf},
    {"tool", StoredKind::kPlain},    {"pointRs", StoredKind::kOtherArm}, {"jointRs", StoredKind::kOtherArm},
    {"num", StoredKind::kPlain},     {"bool", StoredKind::kPlain},       {"string", StoredKind::kPlain},
    {"dio", StoredKind::kPlain},     {"aio", StoredKind::kPlain},        {"sio", StoredKind::kPlain},
    {"mdesc", StoredKind::kPlain},   {"configRx", StoredKind::kPlain},   {"configRs", StoredKind::kPlain},
    {"config", StoredKind::kPlain},  {"screen", StoredKind::kPlain}};

StoredKind kind_of_type(std::string_view type) {
  const auto* const found =
      std::ranges::find(kNewTypes, type, &std::pair<std::string_view, StoredKind>::first);
  return found == std::end(kNewTypes) ? StoredKind::kUnknown : found->second;
}

/// "3", "3 2", "3,2": one to three numbers of digits; empty when it is none of these.
std::vector<std::size_t> dimensions_in(std::string_view text) {
  std::vector<std::size_t> result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" ,"), text.size());
    if (end > 0) {
      std::size_t value = 0;
      const auto [rest, error] = std::from_chars(text.data(), text.data() + end, value);
      if (error != std::errc{} || rest != text.data() + end || value > kDimensionMax ||
          result.size() == kDimensionsMax)
        return {};
      result.push_back(value);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

std::string_view unquoted(std::string_view text) {
  return text.size() >= 2 && text.starts_with('"') && text.ends_with('"') ? text.substr(1, text.size() - 2)
                                                                          : text;
}

FrameName father_named(const XmlText& xml, pugi::xml_node element, const std::string& text) {
  FrameName father;
  std::string_view rest = text;
  if (rest.ends_with(']')) {
    const std::size_t open = rest.find('[');
    if (open == std::string_view::npos)
      xml.fail(element, "fatherId is " + in_quotes(text) + "; write name[index]");
    father.key = unquoted(rest.substr(open + 1, rest.size() - open - 2));
    rest = rest.substr(0, open);
  }
  if (const std::size_t colon = rest.find(':'); colon != std::string_view::npos) {
    father.alias = rest.substr(0, colon);
    rest.remove_prefix(colon + 1);
  }
  father.name = rest;
  if (father.name.empty()) xml.fail(element, "fatherId is " + in_quotes(text) + "; write name[index]");
  return father;
}

/// True where an index of an array may be this; arrays of more dimensions are numbered in either way, which
/// no manual settles.
bool is_inside(const std::string& key, const std::vector<std::size_t>& sizes) {
  const std::vector<std::size_t> index = dimensions_in(key);
  if (index.size() != sizes.size()) {
    std::size_t all = 1;
    for (const std::size_t size : sizes) all *= std::min(size, kStoredElementsMax);
    return index.size() == 1 && index[0] < all;
  }
  for (std::size_t i = 0; i < index.size(); ++i)
    if (index[i] >= sizes[i]) return false;
  return true;
}

class NewDataReader {
 public:
  explicit NewDataReader(VariableReader& reader) : reader_(reader), xml_(reader.xml) {}

  void run() {
    const pugi::xml_node datas = element_named(xml_.root(), "Datas");
    for (const pugi::xml_node node : datas.children())
      if (node.type() == pugi::node_element && unprefixed(node.name()) == "Data") variable(node);
  }

 private:
  void variable(pugi::xml_node node) {
    StoredVariable result{.name = reader_.required(node, "name"),
                          .type = reader_.required(node, "type"),
                          .line = xml_.line_of(node)};
    result.kind = kind_of_type(result.type);
    result.is_collection = xsi_type_of(node) == "collection";
    const bool is_read = result.kind == StoredKind::kPoint || result.kind == StoredKind::kJoint ||
                         result.kind == StoredKind::kFrame || result.kind == StoredKind::kTrsf;
    if (is_read) elements(node, result);
    reader_.keep(node, std::move(result));
  }

  void elements(pugi::xml_node node, StoredVariable& variable) {
    const std::string size = node.attribute("size").as_string("1");
    const std::vector<std::size_t> sizes = dimensions_in(size);
    if (!variable.is_collection && sizes.empty())
      xml_.fail(node, "the size of " + in_quotes(variable.name) + " is " + in_quotes(size) +
                          "; write one to three numbers of elements");
    std::set<std::string> keys;
    for (const pugi::xml_node value : node.children()) {
      if (value.type() != pugi::node_element || unprefixed(value.name()) != "Value") continue;
      StoredElement one = element(value, variable);
      if (!variable.is_collection && !is_inside(one.key, sizes))
        xml_.fail(value, "[" + one.key + "] is no element of " + in_quotes(variable.name) +
                             ", whose size is " + size + "; an array counts from 0");
      if (!keys.insert(one.key).second)
        xml_.fail(value, shown_element(variable, one.key) + " is there twice; remove one of them");
      variable.elements.push_back(std::move(one));
    }
    variable.size = variable.elements.size();
    if (variable.is_collection) return;
    variable.size = 1;
    for (const std::size_t length : sizes)
      variable.size = std::min(variable.size * std::min(length, kDimensionMax), kDimensionMax);
  }

  StoredElement element(pugi::xml_node value, const StoredVariable& variable) {
    reader_.take_element(value);
    StoredElement result{.line = xml_.line_of(value)};
    const std::string key = value.attribute("key").as_string(variable.is_collection ? "" : "0");
    if (variable.is_collection && key.empty())
      xml_.fail(value, "a value of the collection " + in_quotes(variable.name) + " has no key; write it");
    result.key = variable.is_collection ? key : reader_.index_key(value, key);
    result.numbers =
        number_places(xml_, value, variable.kind == StoredKind::kJoint ? kJointNames : kTrsfNames);
    const std::string father = value.attribute("fatherId").value();
    if (!father.empty()) result.father = father_named(xml_, value, father);
    if (variable.kind == StoredKind::kPoint) result.posture = reader_.posture_of(value);
    return result;
  }

  VariableReader& reader_;
  const XmlText& xml_;
};

/// The place of the word among `words`; `letter` stands before it or is left out. 0 where it is missing.
std::size_t posture_word(const XmlText& xml, pugi::xml_node element, const char* name, char letter,
                         std::initializer_list<std::string_view> words) {
  std::string text = element.attribute(name).value();
  if (text.empty()) return 0;
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  std::string wanted;
  std::size_t at = 0;
  for (const std::string_view word : words) {
    if (text == word || letter + text == word) return at;
    wanted += (at == 0 ? "" : ", ") + std::string(word);
    ++at;
  }
  xml.fail(element, std::string(name) + " is " + in_quotes(text) + "; write one of " + wanted);
}

}  // namespace

std::string VariableReader::required(pugi::xml_node element, const char* name) const {
  std::string text = element.attribute(name).value();
  if (text.empty())
    xml.fail(element,
             std::string(unprefixed(element.name())) + " has no " + name + "; write " + name + "=\"...\"");
  return text;
}

PostureWords VariableReader::posture_of(pugi::xml_node element) const {
  PostureWords posture;
  posture.shoulder = static_cast<ShoulderWord>(
      posture_word(xml, element, "shoulder", 's', {"ssame", "sfree", "righty", "lefty"}));
  posture.elbow = static_cast<ElbowWord>(
      posture_word(xml, element, "elbow", 'e', {"esame", "efree", "epositive", "enegative"}));
  posture.wrist = static_cast<WristWord>(
      posture_word(xml, element, "wrist", 'w', {"wsame", "wfree", "wpositive", "wnegative"}));
  return posture;
}

std::string VariableReader::index_key(pugi::xml_node element, const std::string& text) const {
  const std::vector<std::size_t> index = dimensions_in(text);
  if (index.empty()) xml.fail(element, in_quotes(text) + " is no index; write one to three numbers");
  std::string key;
  for (const std::size_t i : index) key += (key.empty() ? "" : ",") + std::to_string(i);
  return key;
}

void VariableReader::take_element(pugi::xml_node element) {
  if (elements_left == 0)
    xml.fail(element, "is the value after " + std::to_string(kStoredElementsMax) +
                          " others, which are all that are read; divide the file");
  --elements_left;
}

void VariableReader::keep(pugi::xml_node element, StoredVariable variable) {
  const auto [place, is_new] = data.places.emplace(variable.name, data.variables.size());
  if (!is_new)
    xml.fail(element, in_quotes(variable.name) + " is there twice, first in line " +
                          std::to_string(data.variables[place->second].line) + "; rename one of them");
  data.variables.push_back(std::move(variable));
}

StoredData read_stored_data(const XmlText& xml) {
  VariableReader reader(xml);
  if (unprefixed(xml.root().name()) == "Database" && xml.root_space().starts_with(kNewDataSpace)) {
    NewDataReader(reader).run();
  } else if (unprefixed(xml.root().name()) == "dataList" && xml.root_space() == "DataNameSpace") {
    read_old_stored_data(reader);
  } else {
    xml.fail(xml.root(), in_quotes(std::string(unprefixed(xml.root().name()))) + " of " +
                             in_quotes(std::string(xml.root_space())) +
                             " is no VAL3 data of s5 to s8; give a .dtx file");
  }
  return std::move(reader.data);
}

std::string shown_element(const StoredVariable& variable, const std::string& key) {
  return variable.name + (variable.is_collection ? "[\"" + key + "\"]" : '[' + key + ']');
}

}  // namespace cell
