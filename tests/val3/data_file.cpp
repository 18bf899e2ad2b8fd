#include "tests/val3/data_file.hpp"

#include <algorithm>
#include <charconv>
#include <set>

namespace val3 {
namespace {

/// One <Value> of one variable. Throws Problem.
class ValueReader {
 public:
  ValueReader(const Element& element, const std::string& file) : element_(element), file_(file) {}

  Value read(Type type) {
    Value value = default_value(type);
    std::visit([this](auto& v) { fill(v); }, value);
    for (const auto& [key, text] : element_.attributes)
      if (key != "key" && !used_.contains(key)) fail("attribute " + key + " does not belong to this type");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { throw Problem{file_, element_.line, text}; }

  const std::string* take(const std::string& key) {
    const auto found = element_.attributes.find(key);
    if (found == element_.attributes.end()) return nullptr;
    used_.insert(key);
    return &found->second;
  }
  void number(const std::string& key, double& target) {
    const std::string* text = take(key);
    if (text == nullptr) return;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), target);
    if (error != std::errc{} || end != text->data() + text->size()) fail(key + " is no number");
  }
  void link(std::string& target) {
    const std::string* text = take("link");
    if (text == nullptr || text->find('\\') == std::string::npos) fail("link=\"Board\\Name\" is missing");
    target = *text;
  }
  void father(const std::string& expected) {
    const std::string* text = take("fatherId");
    if (text != nullptr && *text != expected) fail("fatherId is not " + expected);
  }

  void fill(double& v) { number("value", v); }
  void fill(bool& v) {
    const std::string* text = take("value");
    if (text != nullptr && *text != "true" && *text != "false") fail("value is neither true nor false");
    v = text != nullptr && *text == "true";
  }
  void fill(std::string& v) {
    if (const std::string* text = take("value")) v = *text;
  }
  void fill(Joint& v) {
    for (std::size_t i = 0; i < v.size(); ++i) number("j" + std::to_string(i + 1), v[i]);
  }
  void fill(Trsf& v) {
    number("x", v.x);
    number("y", v.y);
    number("z", v.z);
    number("rx", v.rx);
    number("ry", v.ry);
    number("rz", v.rz);
  }
  void fill(Point& v) {
    fill(v.trsf);
    for (const char* part : {"shoulder", "elbow", "wrist"}) take(part);
    const std::string* text = take("fatherId");
    if (text == nullptr || !text->ends_with("[0]")) fail("fatherId=\"world[0]\" is missing");
    v.father = text->substr(0, text->size() - 3);
  }
  void fill(Frame& v) {
    fill(v.trsf);
    father("world[0]");
  }
  void fill(Tool& v) {
    fill(v.trsf);
    father("flange[0]");
    take("ioLink");
  }
  void fill(Mdesc& v) {
    number("accel", v.accel);
    number("vel", v.vel);
    number("decel", v.decel);
    number("tmax", v.tvel);
    number("rmax", v.rvel);
    number("leave", v.leave);
    number("reach", v.reach);
    const std::string* text = take("blend");
    if (text == nullptr) return;
    if (*text == "off")
      v.blend = Blend::kOff;
    else if (*text == "joint")
      v.blend = Blend::kJoint;
    else if (*text == "Cartesian")
      v.blend = Blend::kCartesian;
    else
      fail("blend is none of off, joint, Cartesian");
  }
  void fill(Dio& v) { link(v.link); }
  void fill(Sio& v) { link(v.link); }
  void fill(Blend&) { fail("no type of a variable"); }

  const Element& element_;
  const std::string& file_;
  std::set<std::string> used_;
};

std::size_t whole_number(const std::string& text, const Element& at, const std::string& file) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number > 100000)
    throw Problem{file, at.line, "'" + text + "' is no size or key"};
  return number;
}

void read_variable(const Element& data, const std::string& file, Application& application) {
  const auto fail = [&](const std::string& text) { throw Problem{file, data.line, text}; };
  if (data.name != "Data") fail("<" + data.name + "> among the data");
  const std::string name = data.attribute("name");
  const std::string access = data.attribute("access");
  if (access != "public" && access != "private") fail(name + ": access is neither public nor private");
  if (data.attribute("xsi:type") != "array") fail(name + ": xsi:type is not array");
  const Type type = type_named(data.attribute("type"));
  if (type == Type::kNone) fail(name + ": unknown type " + data.attribute("type"));
  const std::size_t size = whole_number(data.attribute("size"), data, file);
  if (size == 0) fail(name + ": size 0");

  Global global{.type = type, .place = new_variable(type, size), .line = data.line};
  const bool needs_link = type == Type::kDio || type == Type::kSio;
  if (needs_link && data.children.size() != size) fail(name + ": not every element has a link");
  std::set<std::size_t> keys;
  for (const Element& value : data.children) {
    if (value.name != "Value") throw Problem{file, value.line, "<" + value.name + "> is no Value"};
    const std::size_t key = whole_number(value.attribute("key"), value, file);
    if (key >= size)
      throw Problem{file, value.line, name + ": key " + std::to_string(key) + " is beyond its size"};
    if (!keys.insert(key).second)
      throw Problem{file, value.line, name + ": key " + std::to_string(key) + " twice"};
    (*global.place.elements)[key] = ValueReader(value, file).read(type);
  }
  if (type == Type::kFrame)
    for (Value& value : *global.place.elements) std::get<Frame>(value).name = name;
  if (!application.globals.emplace(name, std::move(global)).second) fail(name + " is declared twice");
}

}  // namespace

void read_data(const Element& database, const std::string& file, Application& application,
               std::vector<Problem>& problems) {
  const Element* datas = database.child("Datas");
  if (database.name != "Database" || datas == nullptr ||
      database.space != "http://www.staubli.com/robotics/VAL3/Data/2") {
    problems.push_back({file, database.line, "not a Database of namespace VAL3/Data/2 with Datas"});
    return;
  }
  for (const Element& data : datas->children) {
    try {
      read_variable(data, file, application);
    } catch (const Problem& problem) {
      problems.push_back(problem);
    }
  }
}

}  // namespace val3
