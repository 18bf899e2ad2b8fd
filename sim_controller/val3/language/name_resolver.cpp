/// Names, indices and fields: what an expression stands for.
#include <algorithm>
#include <cctype>
#include <cmath>

#include "sim_controller/val3/language/expression_resolver.hpp"
#include "sim_controller/val3/language/instructions.hpp"
#include "sim_controller/val3/language/resolver_rules.hpp"

namespace val3 {
namespace {

bool same_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

template <class Named, class Name>
int place_in(const std::vector<Named>& all, std::string_view wanted, Name name_of_one) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::string_view(name_of_one(all[i])) == wanted) return static_cast<int>(i);
  return -1;
}
const std::string& local_name(const Declaration& local) { return local.name; }
const std::string& parameter_name(const Parameter& parameter) { return parameter.name; }

/// A name that was meant: of the same letters in another case.
std::string meant_name(const Application& application, const Program& program, std::string_view name) {
  for (const Declaration& local : program.locals)
    if (same_but_for_case(local.name, name)) return local.name;
  for (const Parameter& parameter : program.parameters)
    if (same_but_for_case(parameter.name, name)) return parameter.name;
  for (const Global& global : application.globals)
    if (same_but_for_case(global.declared.name, name)) return global.declared.name;
  return {};
}

/// Of a SCARA. What gives joints or points gives those of the arm, which of the two is not known here: its
/// variables are not checked.
bool is_of_scara(Kind kind) {
  return kind == Kind::kJointRs || kind == Kind::kPointRs || kind == Kind::kConfigRs;
}

}  // namespace

void ExpressionResolver::resolve_name(Expression& e) {
  if (!e.alias.empty()) return resolve_library_name(e);
  using To = Reference::To;
  const auto found = [&](To to, int index, const Type& type, bool is_place) {
    e.reference = {to, -1, index, nullptr};
    e.type = type;
    e.is_place = is_place;
    e.is_unknown = !is_known(scope_.application(), type) || is_of_scara(type.kind);
  };
  if (const int local = place_in(program_.locals, e.text, local_name); local >= 0)
    return found(To::kLocal, local, program_.locals[static_cast<std::size_t>(local)].type, true);
  if (const int parameter = place_in(program_.parameters, e.text, parameter_name); parameter >= 0)
    return found(To::kParameter, parameter, program_.parameters[static_cast<std::size_t>(parameter)].type,
                 true);
  if (const int global = scope_.global(e.text); global >= 0)
    return found(To::kGlobal, global,
                 scope_.application().globals[static_cast<std::size_t>(global)].declared.type, true);
  if (e.text == "world") return found(To::kWorld, -1, {Kind::kFrame, -1}, true);
  if (e.text == "flange") return found(To::kFlange, -1, {Kind::kTool, -1}, true);
  if (const Word word = word_named(e.text); word.index >= 0)
    return found(To::kWord, word.index, {word.kind, -1}, false);
  resolve_undefined(e);
}

void ExpressionResolver::resolve_undefined(Expression& e) {
  if (scope_.program(e.text) >= 0)
    return fail(resolver_rules::kUndefinedName, e, e.text + " is a program, not a variable",
                "programs have no result: give it a variable by reference, and call " + e.text + "(...)");
  if (find_instruction(e.text) != nullptr)
    return fail(resolver_rules::kUndefinedName, e, e.text + " is an instruction", "write " + e.text + "()");
  if (scope_.application().has_unread_data) {
    e.is_unknown = true;
    e.is_place = true;
    return;
  }
  const std::string meant = meant_name(scope_.application(), program_, e.text);
  fail(
      resolver_rules::kUndefinedName, e, "nothing is called " + e.text,
      meant.empty() ? "declare it, or correct the name" : "write " + meant + ": upper and lower case differ");
}

void ExpressionResolver::resolve_library_name(Expression& e) {
  const int library = scope_.library(e.alias);
  const Scope* const there = library < 0 ? nullptr : scope_.of_library(library);
  if (there == nullptr) {
    if (library < 0) {
      fail(resolver_rules::kUndefinedLibrary, e, "no library has the alias " + e.alias,
           "declare it in the project");
    } else {
      e.is_unknown = true;
    }
    return;
  }
  const int global = there->global(e.text);
  if (global < 0 && there->application().is_built_in) return resolve_unknown_signal(there->application(), e);
  if (global < 0)
    return fail(resolver_rules::kUndefinedName, e,
                "nothing is called " + e.text + " in the library " + e.alias,
                there->program(e.text) >= 0 ? "it is a program there: call " + full_name(e) + "(...)" : "");
  const Global& found = there->application().globals[static_cast<std::size_t>(global)];
  e.reference = {Reference::To::kGlobal, library, global, nullptr};
  e.type = scope_.imported(there->application(), found.declared.type);
  e.is_place = true;
  e.is_unknown = !is_known(scope_.application(), e.type) || is_of_scara(e.type.kind);
  if (!found.is_public)
    tell(Severity::kError, resolver_rules::kNotPublic, e, full_name(e) + " is not public in that library",
         "make it public there");
}

/// The cell may have it, on a board or fieldbus: its project `io` is not here to tell. Only a name that
/// differs from a signal's by letter case is hardly another one's.
void ExpressionResolver::resolve_unknown_signal(const Application& io, Expression& e) {
  e.is_unknown = true;
  e.is_place = true;
  const auto meant = std::ranges::find_if(
      io.globals, [&](const Global& signal) { return same_but_for_case(signal.declared.name, e.text); });
  tell(meant == io.globals.end() ? Severity::kNote : Severity::kWarning, resolver_rules::kUnknownSignal, e,
       "no signal is called " + e.text + " in the library io that a controller has by itself",
       meant == io.globals.end()
           ? "put the cell's project io beside the application, or correct the name"
           : "write " + e.alias + ":" + meant->declared.name + ": upper and lower case differ");
}

void ExpressionResolver::resolve_index(Expression& e) {
  Expression& base = e.parts[0];
  resolve(base);
  for (std::size_t i = 1; i < e.parts.size(); ++i) {
    resolve(e.parts[i]);
    (void)has_result(e.parts[i]);
  }
  e.type = base.type;
  e.is_place = true;
  e.is_unknown = base.is_unknown;
  if (e.is_unknown) return;
  const Shape counted = shape(base);
  if (!base.is_place || !counted.has_elements())
    return fail(resolver_rules::kIndexNotAllowed, e, "an index behind what has no elements");
  check_index(counted, e);
}

void ExpressionResolver::check_index(const Shape& counted, Expression& e) {
  const std::size_t given = e.parts.size() - 1;
  const std::string name = full_name(e.parts[0]);
  if (counted.is_collection) {
    if (given != 1) return fail(resolver_rules::kIndexCount, e, name + " is a collection: it takes one key");
    if (e.parts[1].is_unknown || e.parts[1].type.kind == Kind::kString) return;
    return fail(resolver_rules::kIndexType, e, name + " is a collection: its keys are strings");
  }
  for (std::size_t i = 1; i < e.parts.size(); ++i) {
    const Expression& index = e.parts[i];
    const bool is_number = index.type.kind == Kind::kNum || index.type.kind == Kind::kAio;
    if (index.is_unknown || (is_number && index.kind != Expression::Kind::kBraces)) continue;
    return fail(resolver_rules::kIndexType, e, "an index is a num, and this is a " + type_name(index));
  }
  if (given != static_cast<std::size_t>(counted.dimensions))
    return fail(resolver_rules::kIndexCount, e,
                name + " has " + std::to_string(counted.dimensions) + " dimensions, and " +
                    std::to_string(given) + " indices stand here");
  const bool is_first = e.parts[1].kind == Expression::Kind::kNumber && std::floor(e.parts[1].number) == 0.0;
  if (counted.is_element && !is_first)
    tell(Severity::kWarning, resolver_rules::kElementIndex, e,
         name + " is given as one element: an index above 0 is outside it",
         "declare the parameter as an array");
}

void ExpressionResolver::resolve_field(Expression& e) {
  Expression& base = e.parts[0];
  resolve(base);
  e.is_place = base.is_place;
  e.is_unknown = base.is_unknown;
  if (e.is_unknown) return;
  if (base.kind == Expression::Kind::kBraces) return fail_without_type(e);
  e.type = field_type(scope_.application(), base.type, e.text);
  if (is_known(scope_.application(), e.type)) return;
  // A field whose type the reader did not know is told there.
  if (shape(e).has_elements())
    e.is_unknown = true;
  else
    fail(resolver_rules::kUndefinedField, e, "a " + type_name(base) + " has no field " + e.text);
}

}  // namespace val3
