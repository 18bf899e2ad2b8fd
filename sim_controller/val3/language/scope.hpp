#pragma once

#include <cstddef>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sim_controller/val3/program/application.hpp"

namespace val3 {

/// What names stand for in one application. It outlives neither the application nor a change of its programs,
/// globals or libraries; only user types are added, those of the libraries' symbols.
class Scope {
 public:
  explicit Scope(Application& application);

  [[nodiscard]] const Application& application() const { return application_; }
  /// Index, or -1.
  [[nodiscard]] int global(std::string_view name) const { return found(globals_, name); }
  [[nodiscard]] int program(std::string_view name) const { return found(programs_, name); }
  [[nodiscard]] int library(std::string_view alias) const { return found(libraries_, alias); }
  /// Of a library that is there; `library` is an index.
  [[nodiscard]] const Scope* of_library(int library) const {
    return library_scopes_[static_cast<std::size_t>(library)];
  }
  void set_library_scope(std::size_t library, const Scope* scope) { library_scopes_[library] = scope; }
  /// What a type of a library is in this application, by its name; it is added where it is not there.
  Type imported(const Application& library, const Type& type);

 private:
  using Names = std::unordered_map<std::string_view, int>;
  static int found(const Names& names, std::string_view name) {
    const auto at = names.find(name);
    return at == names.end() ? -1 : at->second;
  }

  Application& application_;
  Names globals_, programs_, libraries_;
  std::vector<const Scope*> library_scopes_;
};

/// How a variable's elements are counted.
struct Shape {
  int dimensions = 1;
  bool is_collection = false;
  bool is_element = false;  // a parameter that is one element
  const Declaration* declared = nullptr;

  [[nodiscard]] bool has_elements() const { return dimensions > 0 || is_collection; }
};
/// Of a variable or of a field of a user type, without an index; no dimensions for any other expression.
Shape shape_of(const Scope& scope, const Program& program, const Expression& variable);

/// The variable at the root of a place: of x[i].f it is x.
const Expression& root_of(const Expression& place);

/// The place of a word in its type's list: off, righty, epositive ...; kVoid when it is none.
struct Word {
  Kind kind = Kind::kVoid;
  int index = -1;
};
Word word_named(std::string_view text);

/// Types of two applications, or of one, that are the same but for their names and the places of their
/// projects.
bool have_same_fields(const Application& of_a, const UserType& a, const Application& of_b, const UserType& b);
/// False for a type that the reader did not know, or whose project it did not find: that is told there.
bool is_known(const Application& application, const Type& type);
/// A type's fields, of a user type or built in: kVoid when there is none of that name.
Type field_type(const Application& application, const Type& type, std::string_view field);
std::vector<Type> field_types(const Application& application, const Type& type);

}  // namespace val3
