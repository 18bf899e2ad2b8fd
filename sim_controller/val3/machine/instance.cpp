#include "sim_controller/val3/machine/instance.hpp"

#include <charconv>

#include "sim_controller/val3/machine/geometry.hpp"
#include "sim_controller/val3/machine/libraries.hpp"

namespace val3 {
namespace {

using Attributes = std::map<std::string, std::string>;

const std::string* find_attribute(const Attributes& attributes, const char* name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? nullptr : &found->second;
}

void read_number(const Attributes& attributes, const char* name, double& value) {
  const std::string* text = find_attribute(attributes, name);
  if (text == nullptr) return;
  std::from_chars(text->data(), text->data() + text->size(), value);
}

template <class Word>
void read_word(const Attributes& attributes, const char* name, Word& value,
               std::initializer_list<std::pair<std::string_view, Word>> words) {
  const std::string* text = find_attribute(attributes, name);
  if (text == nullptr) return;
  for (const auto& [word, meaning] : words)
    if (*text == word) value = meaning;
}

}  // namespace

/// Gives elements what a data file stores.
class DataLoader {
 public:
  DataLoader(Instance& instance, System& system, Fathers& fathers)
      : instance_(instance), system_(system), fathers_(fathers) {}

  void load() {
    const Application& application = *instance_.application;
    for (std::size_t i = 0; i < application.globals.size(); ++i) {
      ArrayBase& array = *instance_.globals[i];
      restore(array, application.globals[i].declared);
      fill(array, application.globals[i].values);
    }
  }

 private:
  void fill(ArrayBase& array, const std::vector<StoredValue>& values) {
    if (!is_simulated(array.type().kind)) return;
    for (const StoredValue& value : values) {
      std::size_t flat = 0;
      if (array.sizes.empty()) {
        flat = array.size();
        const auto [place, is_new] = array.keys.emplace(value.key, flat);
        if (is_new) array.resize(flat + 1);
        flat = place->second;
      } else {
        for (std::size_t k = 0; k < value.index.size() && k < array.sizes.size(); ++k)
          flat = flat * array.sizes[k] + value.index[k];
      }
      if (flat >= array.size()) continue;  // the reader has found it
      with_type_of(array.type().kind,
                   [&]<class T>() { set(static_cast<Array<T>&>(array).elements[flat], value); });
    }
  }

  static void set(double& target, const StoredValue& v) { read_number(v.attributes, "value", target); }
  static void set(bool& target, const StoredValue& v) {
    if (const std::string* text = find_attribute(v.attributes, "value")) target = *text == "true";
  }
  static void set(std::string& target, const StoredValue& v) {
    if (const std::string* text = find_attribute(v.attributes, "value")) target = *text;
  }
  void set(Dio& target, const StoredValue& v) { link(target, v, "link", &System::find_digital); }
  void set(Aio& target, const StoredValue& v) { link(target, v, "link", &System::find_analogue); }
  void set(Sio& target, const StoredValue& v) { link(target, v, "link", &System::find_channel); }
  void link(Link& target, const StoredValue& v, const char* name,
            std::optional<int> (System::*find)(std::string_view)) {
    const std::string* text = find_attribute(v.attributes, name);
    if (text != nullptr && !text->empty()) target.id = (system_.*find)(*text).value_or(-1);
  }
  static void set(Trsf& target, const StoredValue& v) {
    read_number(v.attributes, "x", target.x);
    read_number(v.attributes, "y", target.y);
    read_number(v.attributes, "z", target.z);
    read_number(v.attributes, "rx", target.rx);
    read_number(v.attributes, "ry", target.ry);
    read_number(v.attributes, "rz", target.rz);
  }
  static void set(Joint& target, const StoredValue& v) { set_axes(target, v); }
  static void set(JointRs& target, const StoredValue& v) { set_axes(target, v); }
  template <class Axes>
  static void set_axes(Axes& target, const StoredValue& v) {
    for (std::size_t i = 0; i < target.size(); ++i)
      read_number(v.attributes, ("j" + std::to_string(i + 1)).c_str(), target[i]);
  }
  static void set(Config& target, const StoredValue& v) {
    read_word<Shoulder>(v.attributes, "shoulder", target.shoulder,
                        {{"righty", Shoulder::kRighty},
                         {"lefty", Shoulder::kLefty},
                         {"ssame", Shoulder::kSame},
                         {"same", Shoulder::kSame},
                         {"sfree", Shoulder::kFree},
                         {"free", Shoulder::kFree}});
    read_word<Elbow>(v.attributes, "elbow", target.elbow,
                     {{"epositive", Elbow::kPositive},
                      {"positive", Elbow::kPositive},
                      {"enegative", Elbow::kNegative},
                      {"negative", Elbow::kNegative},
                      {"esame", Elbow::kSame},
                      {"same", Elbow::kSame},
                      {"efree", Elbow::kFree},
                      {"free", Elbow::kFree}});
    read_word<Wrist>(v.attributes, "wrist", target.wrist,
                     {{"wpositive", Wrist::kPositive},
                      {"positive", Wrist::kPositive},
                      {"wnegative", Wrist::kNegative},
                      {"negative", Wrist::kNegative},
                      {"wsame", Wrist::kSame},
                      {"same", Wrist::kSame},
                      {"wfree", Wrist::kFree},
                      {"free", Wrist::kFree}});
  }
  void set(Point& target, const StoredValue& v) {
    set(target.trsf, v);
    set(target.config, v);
    set_father(target.father, v);
  }
  void set(Frame& target, const StoredValue& v) {
    set(target.trsf, v);
    set_father(target.father, v);
  }
  void set(Tool& target, const StoredValue& v) {
    set(target.trsf, v);
    set_father(target.father, v);
    link(target.gripper, v, "ioLink", &System::find_digital);
    read_number(v.attributes, "ioOpen", target.open_s);
    read_number(v.attributes, "ioClose", target.close_s);
  }
  static void set(Mdesc& target, const StoredValue& v) {
    read_number(v.attributes, "accel", target.accel);
    read_number(v.attributes, "vel", target.vel);
    read_number(v.attributes, "decel", target.decel);
    read_number(v.attributes, "tmax", target.tvel);
    read_number(v.attributes, "rmax", target.rvel);
    read_number(v.attributes, "leave", target.leave);
    read_number(v.attributes, "reach", target.reach);
    read_word<Blend>(v.attributes, "blend", target.blend,
                     {{"off", Blend::kOff},
                      {"joint", Blend::kJoint},
                      {"cartesian", Blend::kCartesian},
                      {"Cartesian", Blend::kCartesian}});
  }
  void set(Record& target, const StoredValue& v) {
    for (const StoredField& field : v.fields) {
      const auto& declared = instance_.application->user_types;
      for (const UserType& type : declared)
        for (std::size_t i = 0; i < type.fields.size() && i < target.fields.size(); ++i)
          if (type.fields[i].declared.name == field.declared.name &&
              target.fields[i]->type() == field.declared.type) {
            size_as_stored(*target.fields[i], field.declared);
            fill(*target.fields[i], field.values);
          }
    }
  }
  template <class T>
  static void set(T&, const StoredValue&) {}

  /// A variable's field has the size that its data store, whatever that of its type.
  static void size_as_stored(ArrayBase& array, const Declaration& stored) {
    if (array.sizes.size() != stored.sizes.size() || stored.is_collection() || array.sizes == stored.sizes)
      return;
    array.resize(stored.count());
    array.sizes = stored.sizes;
  }

  /// "name[i]", or "alias:name[i]".
  void set_father(Father& target, const StoredValue& v) {
    const std::string* text = find_attribute(v.attributes, "fatherId");
    if (text == nullptr) return;
    target = {};
    std::string_view name = *text;
    std::size_t element = 0;
    if (const std::size_t open = name.find('['); open != std::string_view::npos) {
      std::from_chars(name.data() + open + 1, name.data() + name.size(), element);
      name = name.substr(0, open);
    }
    if (name == "world" || name == "flange") {
      target = {name == "world" ? kWorldArray : kFlangeArray, 0};
      return;
    }
    const Instance* owner = &instance_;
    if (const std::size_t colon = name.find(':'); colon != std::string_view::npos) {
      const int library = instance_.application->library_named(name.substr(0, colon));
      owner = library < 0 ? nullptr : instance_.libraries[static_cast<std::size_t>(library)];
      name = name.substr(colon + 1);
    }
    if (owner == nullptr) return;
    const int global = owner->application->global_named(name);
    if (global < 0) return;
    target = fathers_.father_of(
        {.array = owner->globals[static_cast<std::size_t>(global)].get(), .index = element});
  }

  Instance& instance_;
  System& system_;
  Fathers& fathers_;
};

Instance::Instance() = default;
Instance::~Instance() = default;

ArrayBase& Instance::global(const Reference& reference) const {
  const Instance& owner =
      reference.library < 0 ? *this : *libraries[static_cast<std::size_t>(reference.library)];
  return *owner.globals[static_cast<std::size_t>(reference.index)];
}

std::shared_ptr<ArrayBase> make_variable(const Application& application, const Declaration& declared) {
  const std::size_t count = declared.count();
  auto made = with_type_of(declared.type.kind, [&]<class T>() -> std::shared_ptr<ArrayBase> {
    if constexpr (std::is_same_v<T, Record>) {
      Record initial;
      const UserType& type = application.user_types.at(static_cast<std::size_t>(declared.type.user));
      for (const Global& field : type.fields)
        initial.fields.push_back(make_variable(application, field.declared));
      return std::make_shared<Array<Record>>(declared.type, count, initial);
    } else {
      return std::make_shared<Array<T>>(declared.type, count);
    }
  });
  made->sizes = declared.sizes;
  return made;
}

void restore(ArrayBase& array, const Declaration& declared) {
  if (array.sizes != declared.sizes || declared.is_collection()) {
    array.resize(declared.count());
    array.sizes = declared.sizes;
    array.keys.clear();
  }
  array.clear();
}

void load_data(Instance& instance, System& system, Fathers& fathers, Findings&) {
  DataLoader(instance, system, fathers).load();
}

}  // namespace val3
