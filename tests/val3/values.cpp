#include "tests/val3/values.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace val3 {
namespace {

constexpr std::array<std::pair<std::string_view, Type>, 11> kTypeNames{{{"num", Type::kNum},
                                                                        {"bool", Type::kBool},
                                                                        {"string", Type::kString},
                                                                        {"jointRx", Type::kJoint},
                                                                        {"pointRx", Type::kPoint},
                                                                        {"trsf", Type::kTrsf},
                                                                        {"frame", Type::kFrame},
                                                                        {"tool", Type::kTool},
                                                                        {"mdesc", Type::kMdesc},
                                                                        {"dio", Type::kDio},
                                                                        {"sio", Type::kSio}}};

struct NoField {};
using FieldPointer = std::variant<NoField, double*, Trsf*, Blend*>;

template <class T>
FieldPointer member(T&, std::string_view) {
  return NoField{};
}
FieldPointer member(Joint& joint, std::string_view field) {
  if (field.size() != 2 || field[0] != 'j' || field[1] < '1' || field[1] > '6') return NoField{};
  return &joint[static_cast<std::size_t>(field[1] - '1')];
}
FieldPointer member(Trsf& t, std::string_view field) {
  for (const auto& [name, pointer] : {std::pair<std::string_view, double*>{"x", &t.x},
                                      {"y", &t.y},
                                      {"z", &t.z},
                                      {"rx", &t.rx},
                                      {"ry", &t.ry},
                                      {"rz", &t.rz}})
    if (name == field) return pointer;
  return NoField{};
}
FieldPointer member(Point& p, std::string_view field) {
  if (field == "trsf") return &p.trsf;
  return NoField{};
}
FieldPointer member(Frame& f, std::string_view field) {
  if (field == "trsf") return &f.trsf;
  return NoField{};
}
FieldPointer member(Tool& t, std::string_view field) {
  if (field == "trsf") return &t.trsf;
  return NoField{};
}
FieldPointer member(Mdesc& m, std::string_view field) {
  if (field == "blend") return &m.blend;
  for (const auto& [name, pointer] : {std::pair<std::string_view, double*>{"accel", &m.accel},
                                      {"vel", &m.vel},
                                      {"decel", &m.decel},
                                      {"tvel", &m.tvel},
                                      {"rvel", &m.rvel},
                                      {"leave", &m.leave},
                                      {"reach", &m.reach}})
    if (name == field) return pointer;
  return NoField{};
}

FieldPointer member_of(Value& value, std::string_view field) {
  return std::visit([&](auto& v) { return member(v, field); }, value);
}

FieldPointer follow(Value& value, const std::vector<std::string>& fields) {
  FieldPointer pointer = member_of(value, fields.front());
  for (std::size_t i = 1; i < fields.size(); ++i) {
    Trsf** trsf = std::get_if<Trsf*>(&pointer);
    pointer = trsf == nullptr ? FieldPointer{} : member(**trsf, fields[i]);
  }
  return pointer;
}

}  // namespace

Type type_named(std::string_view word) {
  const auto* found = std::ranges::find(kTypeNames, word, &std::pair<std::string_view, Type>::first);
  return found == kTypeNames.end() ? Type::kNone : found->second;
}

std::string_view name_of(Type type) {
  if (type == Type::kBlend) return "blend";
  const auto* found = std::ranges::find(kTypeNames, type, &std::pair<std::string_view, Type>::second);
  return found == kTypeNames.end() ? "nothing" : found->first;
}

Type type_of(const Value& value) { return static_cast<Type>(value.index() + 1); }

Value default_value(Type type) {
  switch (type) {
    case Type::kNum:
      return 0.0;
    case Type::kBool:
      return false;
    case Type::kString:
      return std::string();
    case Type::kJoint:
      return Joint{};
    case Type::kPoint:
      return Point{};
    case Type::kTrsf:
      return Trsf{};
    case Type::kFrame:
      return Frame{};
    case Type::kTool:
      return Tool{};
    case Type::kMdesc:
      return Mdesc{};
    case Type::kDio:
      return Dio{};
    case Type::kSio:
      return Sio{};
    case Type::kBlend:
      return Blend::kOff;
    case Type::kNone:
      break;
  }
  throw std::logic_error("no value of type nothing");
}

Place Place::element(double index) const {
  const double rounded = std::floor(index);
  if (rounded != index || rounded < 0 || rounded >= static_cast<double>(size()))
    throw RuntimeError(kErrorIndex, "index " + std::to_string(index));
  return {elements, offset + static_cast<std::size_t>(rounded), fields};
}

Value Place::read() const {
  if (size() == 0) throw RuntimeError(kErrorIndex, "no element");
  Value& value = (*elements)[offset];
  if (fields.empty()) return value;
  const FieldPointer pointer = follow(value, fields);
  if (double* const* number = std::get_if<double*>(&pointer)) return **number;
  if (Trsf* const* trsf = std::get_if<Trsf*>(&pointer)) return **trsf;
  if (Blend* const* blend = std::get_if<Blend*>(&pointer)) return **blend;
  throw RuntimeError(kErrorInterpreter, "no field " + fields.front());
}

void Place::write(const Value& value) const {
  if (size() == 0) throw RuntimeError(kErrorIndex, "no element");
  Value& target = (*elements)[offset];
  if (fields.empty()) {
    if (type_of(value) != type_of(target)) throw RuntimeError(kErrorInterpreter, "a value of another type");
    std::string frame_name;  // a frame keeps its own name, which points refer to
    if (const Frame* frame = std::get_if<Frame>(&target)) frame_name = frame->name;
    target = value;
    if (Frame* frame = std::get_if<Frame>(&target)) frame->name = frame_name;
    return;
  }
  const FieldPointer pointer = follow(target, fields);
  if (double* const* number = std::get_if<double*>(&pointer);
      number != nullptr && std::holds_alternative<double>(value))
    **number = std::get<double>(value);
  else if (Trsf* const* trsf = std::get_if<Trsf*>(&pointer);
           trsf != nullptr && std::holds_alternative<Trsf>(value))
    **trsf = std::get<Trsf>(value);
  else if (Blend* const* blend = std::get_if<Blend*>(&pointer);
           blend != nullptr && std::holds_alternative<Blend>(value))
    **blend = std::get<Blend>(value);
  else
    throw RuntimeError(kErrorInterpreter, "field " + fields.front() + " and a value of another type");
}

Place new_variable(Type type, std::size_t size) {
  return {std::make_shared<std::vector<Value>>(size, default_value(type)), 0, {}};
}

Type field_type(Type type, std::string_view field) {
  if (type == Type::kNone || type == Type::kBlend) return Type::kNone;
  Value value = default_value(type);
  const FieldPointer pointer = member_of(value, field);
  constexpr std::array<Type, 4> kTypes{Type::kNone, Type::kNum, Type::kTrsf, Type::kBlend};
  return kTypes[pointer.index()];
}

}  // namespace val3
