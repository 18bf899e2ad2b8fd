// Variables, their elements and their fields as nodes.
#include <cstddef>

#include "sim_controller/val3/machine/compiler.hpp"
#include "sim_controller/val3/machine/libraries.hpp"

namespace val3 {
namespace {

/// A slot's first element; an array parameter's slot begins where it was handed over.
template <class T>
class SlotPlace final : public PlaceNode<T> {
 public:
  explicit SlotPlace(std::size_t slot) : slot_(slot) {}
  T& at(Context& context) const override { return context.here->slots[slot_].template at<T>(); }

 private:
  std::size_t slot_;
};

template <class T>
class GlobalPlace final : public PlaceNode<T> {
 public:
  explicit GlobalPlace(ArrayBase& array) : array_(static_cast<Array<T>&>(array)) {}
  T& at(Context&) const override {
    if (array_.elements.empty()) throw RunFailure(kErrorIndex, "an array without elements");
    return array_.elements[0];
  }

 private:
  Array<T>& array_;
};

/// One index, a number, of a global or a slot.
template <class T>
class GlobalElementPlace final : public PlaceNode<T> {
 public:
  GlobalElementPlace(ArrayBase& array, NodePtr<double> index)
      : array_(static_cast<Array<T>&>(array)), index_(std::move(index)) {}
  T& at(Context& context) const override {
    const double index = index_->get(context);
    return array_.elements[flat_index(array_, 0, &index, 1)];
  }

 private:
  Array<T>& array_;
  NodePtr<double> index_;
};

template <class T>
class RefPlace final : public PlaceNode<T> {
 public:
  explicit RefPlace(RefNodePtr ref) : ref_(std::move(ref)) {}
  T& at(Context& context) const override { return ref_->get(context).template at<T>(); }

 private:
  RefNodePtr ref_;
};

template <class Whole, class Part>
std::ptrdiff_t distance_of(Part Whole::*part) {
  static const Whole whole{};
  return reinterpret_cast<const std::byte*>(&(whole.*part)) -
         reinterpret_cast<const std::byte*>(&whole);  // NOLINT
}

std::ptrdiff_t offset_of_axis(std::string_view field) {
  return static_cast<std::ptrdiff_t>(sizeof(double)) * (field.back() - '1');
}

std::ptrdiff_t offset_in_trsf(std::string_view field) {
  if (field == "x") return distance_of(&Trsf::x);
  if (field == "y") return distance_of(&Trsf::y);
  if (field == "z") return distance_of(&Trsf::z);
  if (field == "rx") return distance_of(&Trsf::rx);
  if (field == "ry") return distance_of(&Trsf::ry);
  if (field == "rz") return distance_of(&Trsf::rz);
  return -1;
}

std::ptrdiff_t offset_in_mdesc(std::string_view field) {
  if (field == "accel") return distance_of(&Mdesc::accel);
  if (field == "vel") return distance_of(&Mdesc::vel);
  if (field == "decel") return distance_of(&Mdesc::decel);
  if (field == "tvel") return distance_of(&Mdesc::tvel);
  if (field == "rvel") return distance_of(&Mdesc::rvel);
  if (field == "blend") return distance_of(&Mdesc::blend);
  if (field == "leave") return distance_of(&Mdesc::leave);
  if (field == "reach") return distance_of(&Mdesc::reach);
  return -1;
}

std::ptrdiff_t offset_in_tool(std::string_view field) {
  if (field == "trsf") return distance_of(&Tool::trsf);
  if (field == "gripper") return distance_of(&Tool::gripper);
  if (field == "otime") return distance_of(&Tool::open_s);
  if (field == "ctime") return distance_of(&Tool::close_s);
  return -1;
}

std::ptrdiff_t offset_in_config(std::string_view field) {
  if (field == "shoulder") return distance_of(&Config::shoulder);
  if (field == "elbow") return distance_of(&Config::elbow);
  if (field == "wrist") return distance_of(&Config::wrist);
  return -1;
}

/// Bytes from the structure to its field; -1: none of that name.
std::ptrdiff_t offset_of(Kind kind, std::string_view field) {
  switch (kind) {
    case Kind::kJoint:
    case Kind::kJointRs:
      return offset_of_axis(field);
    case Kind::kTrsf:
      return offset_in_trsf(field);
    case Kind::kFrame:
      return field == "trsf" ? distance_of(&Frame::trsf) : -1;
    case Kind::kTool:
      return offset_in_tool(field);
    case Kind::kPoint:
      if (field == "trsf") return distance_of(&Point::trsf);
      return field == "config" ? distance_of(&Point::config) : -1;
    case Kind::kConfig:
      return offset_in_config(field);
    case Kind::kMdesc:
      return offset_in_mdesc(field);
    default:
      return -1;
  }
}

/// Behind which the global of a library stands, where that may change while the application runs; else null.
const LibrarySlot* changing_slot(const Instance& instance, const Reference& reference) {
  if (reference.library < 0) return nullptr;
  const LibrarySlot& slot = *instance.slots.at(static_cast<std::size_t>(reference.library));
  return slot.is_fixed ? nullptr : &slot;
}

bool is_fixed_global(const Instance& instance, const Reference& reference) {
  return reference.to == Reference::To::kGlobal && changing_slot(instance, reference) == nullptr;
}

std::size_t slot_of(const Program& program, const Reference& reference) {
  const auto index = static_cast<std::size_t>(reference.index);
  return reference.to == Reference::To::kParameter ? index : program.parameters.size() + index;
}

}  // namespace

void Compiler::refuse_unknown(const Expression& name) const {
  if (name.alias.empty()) refuse(name, "'" + name.text + "' is no variable here");
  const std::string full = "'" + name.alias + ":" + name.text + "'";
  const Application& application = *instance_.application;
  const int library = application.library_named(name.alias);
  if (library < 0 || !application.libraries[static_cast<std::size_t>(library)].application)
    refuse(name, full + " is of a library that is not there", "put its folder beside the application");
  refuse(name, full + " is none of the signals that a controller has by itself",
         "put the cell's project " + name.alias + " beside the application");
}

RefNodePtr Compiler::variable(const Expression& e) {
  const Reference& reference = e.reference;
  switch (reference.to) {
    case Reference::To::kLocal:
    case Reference::To::kParameter: {
      const std::size_t slot = slot_of(program_, reference);
      return lambda_node<Ref>([slot](Context& c) { return c.here->slots[slot]; });
    }
    case Reference::To::kGlobal: {
      if (const LibrarySlot* slot = changing_slot(instance_, reference))
        return lambda_node<Ref>(
            [slot, index = reference.index](Context&) { return Ref{.array = &loaded_global(*slot, index)}; });
      ArrayBase* array = &instance_.global(reference);
      return lambda_node<Ref>([array](Context&) { return Ref{.array = array}; });
    }
    case Reference::To::kWorld:
      return lambda_node<Ref>([world = &fathers_.world()](Context&) { return Ref{.array = world}; });
    case Reference::To::kFlange:
      return lambda_node<Ref>([flange = &fathers_.flange()](Context&) { return Ref{.array = flange}; });
    default:
      refuse_unknown(e);
  }
}

RefNodePtr Compiler::element(const Expression& e) {
  RefNodePtr base = ref(e.parts[0]);
  if (e.parts[1].type.kind == Kind::kString) {
    return lambda_node<Ref>([base = std::move(base), key = value<std::string>(e.parts[1])](Context& c) {
      Ref place = base->get(c);
      const auto found = place.array->keys.find(key->get(c));
      if (found == place.array->keys.end())
        throw RunFailure(kErrorIndex, "a key that the collection does not have");
      place.index = found->second;
      return place;
    });
  }
  if (e.parts.size() == 2) {
    return lambda_node<Ref>([base = std::move(base), index = value<double>(e.parts[1])](Context& c) {
      Ref place = base->get(c);
      const double at = index->get(c);
      place.index = flat_index(*place.array, place.index, &at, 1);
      return place;
    });
  }
  std::vector<NodePtr<double>> indices;
  for (std::size_t i = 1; i < e.parts.size(); ++i) indices.push_back(value<double>(e.parts[i]));
  return lambda_node<Ref>([base = std::move(base), indices = std::move(indices)](Context& c) {
    Ref place = base->get(c);
    std::array<double, 3> at{};
    for (std::size_t i = 0; i < indices.size(); ++i) at[i] = indices[i]->get(c);
    place.index = flat_index(*place.array, place.index, at.data(), indices.size());
    return place;
  });
}

RefNodePtr Compiler::field(const Expression& e) {
  const Type& whole = e.parts[0].type;
  RefNodePtr base = ref(e.parts[0]);
  if (whole.kind == Kind::kUser) {
    const auto& fields = instance_.application->user_types.at(static_cast<std::size_t>(whole.user)).fields;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].declared.name != e.text) continue;
      return lambda_node<Ref>([base = std::move(base), i](Context& c) {
        const Ref place = base->get(c);
        const auto& array = place.at<Record>().fields[i];
        return Ref{.array = array.get(), .keep = array};
      });
    }
    refuse(e, "no field " + e.text);
  }
  const std::ptrdiff_t offset = offset_of(whole.kind, e.text);
  if (offset < 0) refuse(e, "field " + e.text + " is not simulated");
  return lambda_node<Ref>([base = std::move(base), offset](Context& c) {
    Ref place = base->get(c);
    place.field = std::max<std::ptrdiff_t>(place.field, 0) + offset;
    return place;
  });
}

RefNodePtr Compiler::ref(const Expression& e) {
  switch (e.kind) {
    case Expression::Kind::kName:
      return variable(e);
    case Expression::Kind::kIndex:
      return element(e);
    case Expression::Kind::kField:
      return field(e);
    default:
      break;
  }
  // A value handed over by reference keeps its value; what is assigned to it is lost (manual 6, page 22).
  return with_type_of(e.type.kind, [&]<class T>() -> RefNodePtr {
    return lambda_node<Ref>([value = value<T>(e), type = e.type](Context& c) {
      auto copy = std::make_shared<Array<T>>(type, 1, value->get(c));
      return Ref{.array = copy.get(), .keep = copy};
    });
  });
}

template <class T>
PlaceNodePtr<T> Compiler::place(const Expression& e) {
  // Behind a place of one type no element of another is ever read: nothing at run time would see it.
  if (e.type.kind != Kind::kVoid && e.type.kind != kind_of<T>()) refuse(e, "a variable of another type");
  if (e.kind == Expression::Kind::kName) {
    if (is_fixed_global(instance_, e.reference))
      return std::make_unique<GlobalPlace<T>>(instance_.global(e.reference));
    if (e.reference.to == Reference::To::kLocal || e.reference.to == Reference::To::kParameter)
      return std::make_unique<SlotPlace<T>>(slot_of(program_, e.reference));
  }
  const bool one_number = e.kind == Expression::Kind::kIndex && e.parts.size() == 2 &&
                          e.parts[1].type.kind == Kind::kNum && e.parts[0].kind == Expression::Kind::kName;
  if (one_number && is_fixed_global(instance_, e.parts[0].reference))
    return std::make_unique<GlobalElementPlace<T>>(instance_.global(e.parts[0].reference),
                                                   value<double>(e.parts[1]));
  return std::make_unique<RefPlace<T>>(ref(e));
}

template PlaceNodePtr<double> Compiler::place(const Expression&);
template PlaceNodePtr<bool> Compiler::place(const Expression&);
template PlaceNodePtr<std::string> Compiler::place(const Expression&);
template PlaceNodePtr<Dio> Compiler::place(const Expression&);
template PlaceNodePtr<Aio> Compiler::place(const Expression&);
template PlaceNodePtr<Sio> Compiler::place(const Expression&);
template PlaceNodePtr<Trsf> Compiler::place(const Expression&);
template PlaceNodePtr<Frame> Compiler::place(const Expression&);
template PlaceNodePtr<Tool> Compiler::place(const Expression&);
template PlaceNodePtr<Mdesc> Compiler::place(const Expression&);
template PlaceNodePtr<Joint> Compiler::place(const Expression&);
template PlaceNodePtr<JointRs> Compiler::place(const Expression&);
template PlaceNodePtr<Point> Compiler::place(const Expression&);
template PlaceNodePtr<Config> Compiler::place(const Expression&);
template PlaceNodePtr<Screen> Compiler::place(const Expression&);
template PlaceNodePtr<Blend> Compiler::place(const Expression&);
template PlaceNodePtr<Shoulder> Compiler::place(const Expression&);
template PlaceNodePtr<Elbow> Compiler::place(const Expression&);
template PlaceNodePtr<Wrist> Compiler::place(const Expression&);
template PlaceNodePtr<Record> Compiler::place(const Expression&);

}  // namespace val3
