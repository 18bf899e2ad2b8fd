#include "sim_controller/val3/language/scope.hpp"

#include <algorithm>
#include <array>

namespace val3 {
namespace {

struct WordList {
  Kind kind;
  std::array<std::string_view, 4> words;
};
/// In the order of the enumerations in values.hpp.
constexpr WordList kWordLists[] = {
    {Kind::kBlend, {"off", "joint", "Cartesian", ""}},
    {Kind::kShoulder, {"righty", "lefty", "ssame", "sfree"}},
    {Kind::kElbow, {"epositive", "enegative", "esame", "efree"}},
    {Kind::kWrist, {"wpositive", "wnegative", "wsame", "wfree"}},
};

const UserType* user_type(const Application& application, const Type& type) {
  const auto index = static_cast<std::size_t>(type.user);
  if (type.kind != Kind::kUser || type.user < 0 || index >= application.user_types.size()) return nullptr;
  return &application.user_types[index];
}

const Global* user_field(const Application& application, const Type& type, std::string_view field) {
  const UserType* const user = user_type(application, type);
  if (user == nullptr) return nullptr;
  const auto found = std::ranges::find_if(
      user->fields, [&](const Global& one) { return std::string_view(one.declared.name) == field; });
  return found == user->fields.end() ? nullptr : &*found;
}

constexpr int kTypesComparedDeepMax = 16;

bool compare_fields(const Application& of_a, const UserType& a, const Application& of_b, const UserType& b,
                    int deep) {
  if (deep > kTypesComparedDeepMax) return false;
  return std::ranges::equal(a.fields, b.fields, [&](const Global& x, const Global& y) {
    const Type& of_x = x.declared.type;
    const Type& of_y = y.declared.type;
    if (x.declared.name != y.declared.name || x.declared.sizes != y.declared.sizes || of_x.kind != of_y.kind)
      return false;
    const UserType* const inner_a = user_type(of_a, of_x);
    const UserType* const inner_b = user_type(of_b, of_y);
    if (inner_a == nullptr || inner_b == nullptr) return inner_a == inner_b;
    return compare_fields(of_a, *inner_a, of_b, *inner_b, deep + 1);
  });
}

Shape shape_from(const Declaration& declared) {
  return {static_cast<int>(declared.sizes.size()), declared.is_collection(), false, &declared};
}

}  // namespace

bool have_same_fields(const Application& of_a, const UserType& a, const Application& of_b,
                      const UserType& b) {
  return compare_fields(of_a, a, of_b, b, 0);
}

Scope::Scope(Application& application)
    : application_(application), library_scopes_(application.libraries.size(), nullptr) {
  const auto add = [](Names& names, std::string_view name, std::size_t index) {
    names.emplace(name, static_cast<int>(index));
  };
  for (std::size_t i = 0; i < application.globals.size(); ++i)
    add(globals_, application.globals[i].declared.name, i);
  for (std::size_t i = 0; i < application.programs.size(); ++i)
    add(programs_, application.programs[i].name, i);
  for (std::size_t i = 0; i < application.libraries.size(); ++i)
    add(libraries_, application.libraries[i].alias, i);
}

Type Scope::imported(const Application& library, const Type& type) {
  const UserType* const user = user_type(library, type);
  if (user == nullptr || &library == &application_) return type;
  const auto& types = application_.user_types;
  const auto known = std::ranges::find_if(types, [&](const UserType& one) {
    return one.name == user->name && have_same_fields(library, *user, application_, one);
  });
  if (known != types.end()) return {Kind::kUser, static_cast<int>(known - types.begin())};
  const auto index = application_.user_types.size();
  // Its place is taken before its fields are looked at: a type that contains itself ends here.
  application_.user_types.push_back({user->name, {}, {}, user->project});
  std::vector<Global> fields = user->fields;
  for (Global& field : fields) field.declared.type = imported(library, field.declared.type);
  application_.user_types[index].fields = std::move(fields);
  return {Kind::kUser, static_cast<int>(index)};
}

Shape shape_of(const Scope& scope, const Program& program, const Expression& variable) {
  if (variable.kind == Expression::Kind::kField && !variable.parts.empty()) {
    const Global* const field = user_field(scope.application(), variable.parts[0].type, variable.text);
    return field == nullptr ? Shape{.dimensions = 0} : shape_from(field->declared);
  }
  if (variable.kind != Expression::Kind::kName) return {.dimensions = 0};
  const auto index = static_cast<std::size_t>(variable.reference.index);
  switch (variable.reference.to) {
    case Reference::To::kLocal:
      return shape_from(program.locals[index]);
    case Reference::To::kParameter: {
      const int dimensions = program.parameters[index].dimensions;
      return {std::max(dimensions, 1), false, dimensions == 0, nullptr};
    }
    case Reference::To::kGlobal: {
      const int library = variable.reference.library;
      const Application& owner = library < 0 ? scope.application() : scope.of_library(library)->application();
      return shape_from(owner.globals[index].declared);
    }
    case Reference::To::kWorld:
    case Reference::To::kFlange:
      return {};
    default:
      return {.dimensions = 0};
  }
}

const Expression& root_of(const Expression& place) {
  const Expression* root = &place;
  while ((root->kind == Expression::Kind::kIndex || root->kind == Expression::Kind::kField) &&
         !root->parts.empty())
    root = &root->parts[0];
  return *root;
}

bool is_known(const Application& application, const Type& type) {
  if (type.kind != Kind::kUser) return type.kind != Kind::kVoid;
  const UserType* const user = user_type(application, type);
  return user != nullptr && !user->fields.empty();
}

Word word_named(std::string_view text) {
  for (const auto& [kind, words] : kWordLists)
    for (std::size_t i = 0; i < words.size(); ++i)
      if (!words[i].empty() && words[i] == text) return {kind, static_cast<int>(i)};
  return {};
}

Type field_type(const Application& application, const Type& type, std::string_view field) {
  if (type.kind != Kind::kUser) return {field_of(type.kind, field), -1};
  const Global* const found = user_field(application, type, field);
  return found == nullptr ? Type{} : found->declared.type;
}

std::vector<Type> field_types(const Application& application, const Type& type) {
  std::vector<Type> types;
  if (const UserType* const user = user_type(application, type)) {
    for (const Global& field : user->fields) types.push_back(field.declared.type);
  } else {
    for (const Field& field : fields_of(type.kind)) types.push_back({field.kind, -1});
  }
  return types;
}

}  // namespace val3
